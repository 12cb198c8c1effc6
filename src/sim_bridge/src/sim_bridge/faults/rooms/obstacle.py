"""The kind ``object_in_way``."""

from planar import Pose2
from sim_bridge.faults.kind import FaultKind, Stage
from sim_bridge.simulation import box_on_floor

NAME, SIDE, HEIGHT = "fault_box", 0.3, 0.6


class ObjectInWay(FaultKind):
    """A box stands in the way, so many metres ahead of where the robot is."""

    strength = (1.0, 0.5, 10.0)
    unit = "m"

    def begin(self, stage: Stage) -> None:
        place = stage.base_in_world @ Pose2(self._strength, 0.0)
        stage.scene.add([box_on_floor(NAME, (SIDE, SIDE, HEIGHT), place)])

    def end(self, stage: Stage) -> None:
        stage.scene.remove_model(NAME)
