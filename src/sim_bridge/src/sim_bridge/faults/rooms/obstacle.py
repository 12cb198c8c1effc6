"""The kind ``object_in_way``."""

from sim_bridge.faults.rooms.in_way import InWay


class ObjectInWay(InWay):
    """A box stands in the way, so many metres ahead of where the robot is."""

    strength = (1.0, 0.5, 10.0)
    name, size = "fault_box", (0.3, 0.3, 0.6)
