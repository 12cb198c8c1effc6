"""The kind ``way_closed``."""

from sim_bridge.faults.rooms.in_way import InWay


class WayClosed(InWay):
    """A wall stands across the way, so many metres ahead of where the robot is."""

    strength = (1.0, 0.5, 10.0)
    name, size = "fault_wall", (0.1, 1.6, 1.0)
