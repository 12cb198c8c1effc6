"""The command that plays the mission without ROS."""

from argparse import Namespace

from home_service.rehearsal import Rehearsal


def rehearse(options: Namespace) -> int:
    """Rehearses the mission with one seed after the other; prints a line for each and a verdict."""
    stage = (options.loaded_world, options.loaded_robot, options.loaded_map, *options.places.values())
    successes = 0
    for seed in range(options.seed, options.seed + options.runs):
        run = Rehearsal(*stage, seed=seed).run(options.timeout)
        successes += run.verdict.success
        print(f"seed {seed}: {'SUCCESS' if run.verdict.success else 'FAILURE'}: {run.verdict.reason}")
        print(
            f"  {run.simulated_seconds:.1f} s simulated, {run.real_time_factor:.1f} x real time, "
            f"{run.distance_driven:.1f} m driven, localization off by {run.localization_error.mean():.3f} m "
            f"(mean), trajectory {run.trajectory_hash[:16]}",
            flush=True,
        )
    print(f"{successes} of {options.runs} succeeded")
    return 0 if successes == options.runs else 1
