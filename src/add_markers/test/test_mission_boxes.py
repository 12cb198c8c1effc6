"""Boxes of a mission in a simulator that records what it is asked for."""

from add_markers import MissionBoxes, SolidBox
from planar import Pose2

SHELF = Pose2(2.0, 0.0)


class Simulator:
    def __init__(self):
        self.calls = []

    def robot_in_world(self):
        return Pose2()

    def spawn(self, order):
        self.calls.append(("spawn", order.solid.name, order.pose is None))

    def remove(self, name):
        self.calls.append(("remove", name))


def test_a_box_is_spawned_again_where_it_belongs_only_when_that_changes():
    simulator = Simulator()
    boxes = MissionBoxes(simulator)
    standing, carried = SolidBox("crate", 0.3, SHELF), SolidBox("crate", 0.3, None)
    for solids in ([standing], [standing], [carried], []):
        boxes.update(solids)
    assert simulator.calls == [
        ("spawn", "crate", False),
        ("remove", "crate"),
        ("spawn", "crate", True),
        ("remove", "crate"),
    ]
    assert boxes.placed == {}
