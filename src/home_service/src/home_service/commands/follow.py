from dataclasses import dataclass

from evaluation.options import ErrandOptions, GraphOptions


@dataclass(frozen=True)
class Follow(GraphOptions, ErrandOptions):
    """Let a second robot follow the first one through its mission.

    It has separate localization and navigation. Success: no collision, and within 1.5 m for 90 % of the time.

    Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
    """

    def run(self) -> int:
        from headless_mission.inputs import read_errand
        from home_service.ros.following import run_follow

        launch = self.launch("follow.launch", **self.files())
        return run_follow(self, launch, read_errand(self).places)
