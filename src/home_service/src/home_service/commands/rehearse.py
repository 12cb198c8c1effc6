from dataclasses import dataclass

from home_service.options import MissionOptions, count, seconds
from supervision.command_line import option


@dataclass(frozen=True)
class Rehearse(MissionOptions):
    """Plays the home-service mission in one process, without ROS: fast and repeatable."""

    runs: int = option(1, "how many runs, each with the next seed", type=count)
    timeout: float = option(600.0, "simulated seconds a run may take", type=seconds)

    def run(self) -> int:
        from home_service.rehearsal import Rehearsal, parcel_of
        from home_service.stage import read_mission

        home, successes = read_mission(self), 0
        stage = (home.world, home.robot, home.grid, home.mission)
        for seed in range(self.seed, self.seed + self.runs):
            parcel = None if self.mission else parcel_of(home.mission)
            run = Rehearsal(*stage, seed=seed, parcel=parcel, planner=self.planner).run(self.timeout)
            successes += run.verdict.success
            print(f"seed {seed}: {'SUCCESS' if run.verdict.success else 'FAILURE'}: {run.verdict.reason}")
            print(
                f"  {run.simulated_seconds:.1f} s simulated, {run.real_time_factor:.1f} x real time, "
                f"{run.distance_driven:.1f} m driven, "
                f"localization off by {run.localization_error.mean():.3f} m (mean), "
                f"trajectory {run.trajectory_hash[:16]}",
                flush=True,
            )
        print(f"{successes} of {self.runs} succeeded")
        return 0 if successes == self.runs else 1
