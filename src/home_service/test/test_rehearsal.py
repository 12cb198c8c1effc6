from pathlib import Path

from home_service.rehearsal import Rehearsal
from pick_objects import errand_mission
from planar import load_map
from planar.places import places_of_errand
from sim_bridge import load_world, robot_named

MAP = Path(__file__).resolve().parents[3] / "map"


def rehearsed(seed):
    errand = errand_mission(*places_of_errand(MAP / "zones.yaml"))
    world, grid = load_world(MAP / "home.world"), load_map(MAP / "home.yaml")
    return Rehearsal(world, robot_named("turtlebot_lidar"), grid, errand, seed=seed).run(240.0)


def test_a_seed_repeats_the_whole_mission_bit_for_bit_and_another_does_not():
    first, again, other = rehearsed(1001), rehearsed(1001), rehearsed(1002)
    assert first.trajectory_hash == again.trajectory_hash
    assert first.trajectory_hash != other.trajectory_hash
    assert first.verdict.success, first.verdict.reason
    assert other.verdict.success, other.verdict.reason


def test_a_mission_that_takes_too_long_fails_and_says_so():
    errand = errand_mission(*places_of_errand(MAP / "zones.yaml"))
    world, grid = load_world(MAP / "home.world"), load_map(MAP / "home.yaml")
    run = Rehearsal(world, robot_named("turtlebot_lidar"), grid, errand, seed=7).run(simulated_timeout=2.0)
    assert not run.verdict.success
    assert "not done within 2 simulated seconds" in run.verdict.reason
