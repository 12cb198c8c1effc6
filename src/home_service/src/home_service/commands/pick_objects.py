from dataclasses import dataclass

from evaluation.options import GraphOptions, MissionOptions
from evaluation.verdict import ERRAND


@dataclass(frozen=True)
class PickObjects(GraphOptions, MissionOptions):
    """Carry out a mission, by default from the pick-up to the drop-off zone."""

    def run(self) -> int:
        from evaluation.ros.run_modes import run_to_completion
        from headless_mission.inputs import read_mission

        launch = self.launch("pick_objects.launch", **self.files())
        return run_to_completion(self, launch, read_mission(self).places, {ERRAND})
