from dataclasses import dataclass

from home_service.judging.verdict import ERRAND
from home_service.options import GraphOptions, MissionOptions


@dataclass(frozen=True)
class PickObjects(GraphOptions, MissionOptions):
    """Carries out a mission, by default from the pick-up to the drop-off zone."""

    def run(self) -> int:
        from home_service.ros.conducting import carry_out
        from home_service.stage import read_mission

        launch = self.launch("pick_objects.launch", **self.files())
        return carry_out(self, launch, read_mission(self).places, {ERRAND})
