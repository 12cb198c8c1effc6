"""The command that plays the mission without ROS."""

from argparse import Namespace

from add_markers import CarriedParcel
from home_service.rehearsal import Rehearsal
from pick_objects import Mission


def rehearse(options: Namespace) -> int:
    """Rehearses the mission with one seed after the other; prints a line for each and a verdict."""
    stage = (options.loaded_world, options.loaded_robot, options.loaded_map, options.loaded_mission)
    successes = 0
    for seed in range(options.seed, options.seed + options.runs):
        parcel = None if options.mission else _parcel(options.loaded_mission)
        run = Rehearsal(*stage, seed=seed, parcel=parcel).run(options.timeout)
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


def _parcel(errand: Mission) -> CarriedParcel:
    """The marker of the errand between the two zones."""
    return CarriedParcel(*errand.places.values(), errand.settings.pickup_seconds)
