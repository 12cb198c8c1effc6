from dataclasses import dataclass

from evaluation.options import GraphOptions, MissionOptions
from evaluation.verdict import ERRAND


@dataclass(frozen=True)
class PickObjects(GraphOptions, MissionOptions):
    """Drive to the pick-up zone, wait there, and drive to the drop-off zone.

    Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
    """

    def run(self) -> int:
        from evaluation.ros.run_modes import run_to_completion
        from headless_mission.inputs import read_mission

        launch = self.launch("pick_objects.launch", **self.files())
        return run_to_completion(self, launch, read_mission(self).places, {ERRAND})
