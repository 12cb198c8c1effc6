from dataclasses import dataclass

from evaluation.options import ErrandOptions, GraphOptions


@dataclass(frozen=True)
class Follow(GraphOptions, ErrandOptions):
    """Let a second robot follow the first one through its errand."""

    def run(self) -> int:
        from headless_mission.inputs import read_errand
        from home_service.ros.following import run_follow

        launch = self.launch("follow.launch", **self.files())
        return run_follow(self, launch, read_errand(self).places)
