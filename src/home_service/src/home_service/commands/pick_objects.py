from dataclasses import dataclass

from home_service.judging.verdict import ERRAND
from home_service.options import GraphOptions, MissionOptions


@dataclass(frozen=True)
class PickObjects(GraphOptions, MissionOptions):
    """Drive to the pick-up zone, wait there, and drive to the drop-off zone.

    Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
    """

    def run(self) -> int:
        from home_service.inputs import read_mission
        from home_service.ros.run_modes import run_to_completion

        launch = self.launch("pick_objects.launch", **self.files())
        return run_to_completion(self, launch, read_mission(self).places, {ERRAND})
