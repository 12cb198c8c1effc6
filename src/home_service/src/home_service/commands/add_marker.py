from dataclasses import dataclass

from evaluation.options import ErrandOptions, GraphOptions
from evaluation.verdict import DEMO


@dataclass(frozen=True)
class AddMarker(GraphOptions, ErrandOptions):
    """Show the object at pick-up, hide it, and show it at drop-off, at fixed times.

    Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
    """

    def run(self) -> int:
        from evaluation.ros.run_modes import run_to_completion
        from headless_mission.inputs import read_errand

        launch = self.launch("add_marker.launch", **self.files())
        return run_to_completion(self, launch, read_errand(self).places, {DEMO})
