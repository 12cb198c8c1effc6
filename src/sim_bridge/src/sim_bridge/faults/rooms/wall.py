"""The kind ``way_closed``."""

from planar import Pose2
from sim_bridge.faults.kind import FaultKind, Stage
from sim_bridge.simulation import box_on_floor

NAME, WIDTH, THICKNESS, HEIGHT = "fault_wall", 1.6, 0.1, 1.0


class WayClosed(FaultKind):
    """A wall stands across the way, so many metres ahead of where the robot is."""

    strength = (1.0, 0.5, 10.0)
    unit = "m"

    def begin(self, stage: Stage) -> None:
        place = stage.base_in_world @ Pose2(self._strength, 0.0)
        stage.scene.add([box_on_floor(NAME, (THICKNESS, WIDTH, HEIGHT), place)])

    def end(self, stage: Stage) -> None:
        stage.scene.remove_model(NAME)
