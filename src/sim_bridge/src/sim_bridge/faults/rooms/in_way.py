"""What the kinds of fault that put something in the robot's way have in common."""

from itertools import chain, count
from typing import ClassVar, Tuple

from planar import Pose2
from sim_bridge.faults.kind import FaultKind, Stage
from sim_bridge.simulation import box_on_floor


class InWay(FaultKind):
    """A box called ``name`` of ``size``, metres, stands so many metres ahead of where the robot is.

    If there is one of that name already, it gets a number behind it.
    """

    unit = "m"
    name: ClassVar[str]
    size: ClassVar[Tuple[float, float, float]]

    def begin(self, stage: Stage) -> None:
        taken = stage.scene.models.names()
        names = chain([self.name], (f"{self.name}_{number}" for number in count(2)))
        self._put = next(name for name in names if name not in taken)
        place = stage.base_in_world @ Pose2(self._strength, 0.0)
        stage.scene.add([box_on_floor(self._put, self.size, place)])

    def end(self, stage: Stage) -> None:
        if self._put in stage.scene.models.names():  # nobody has taken it away
            stage.scene.remove_model(self._put)
