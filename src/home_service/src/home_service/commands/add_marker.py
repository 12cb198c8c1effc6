from dataclasses import dataclass

from home_service.judging.verdict import DEMO
from home_service.options import ErrandOptions, GraphOptions


@dataclass(frozen=True)
class AddMarker(GraphOptions, ErrandOptions):
    """Show the object at pick-up, hide it, and show it at drop-off, at fixed times.

    Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
    """

    def run(self) -> int:
        from home_service.inputs import read_errand
        from home_service.ros.run_modes import run_to_completion

        launch = self.launch("add_marker.launch", **self.files())
        return run_to_completion(self, launch, read_errand(self).places, {DEMO})
