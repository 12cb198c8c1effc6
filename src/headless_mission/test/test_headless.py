from pathlib import Path

import pytest

from headless_mission import EpisodeConditions, HeadlessMission
from headless_mission.fault_comparison import TAIL
from move_base_lite.navigator.zones import SPEED, NavigationZone, Zones
from pick_objects import errand_mission, parse_mission
from planar import load_map
from planar.maps.places import load_pickup_and_dropoff
from sim_bridge import load_world, robot_named
from sim_bridge.faults import Fault

MAP = Path(__file__).resolve().parents[3] / "map"


def run_episode(seed, *faults, zones=Zones()):
    errand = errand_mission(*load_pickup_and_dropoff(MAP / "zones.yaml"))
    world, grid = load_world(MAP / "home.world"), load_map(MAP / "home.yaml")
    stage = (world, robot_named("turtlebot_lidar"), grid, errand)
    return HeadlessMission(*stage, seed=seed, conditions=EpisodeConditions(faults=faults, zones=zones)).run(
        240.0
    )


def test_a_seed_repeats_the_whole_mission_bit_for_bit_and_another_does_not():
    first, again, other = run_episode(1001), run_episode(1001), run_episode(1002)
    assert first.trajectory_hash == again.trajectory_hash
    assert first.trajectory_hash != other.trajectory_hash
    assert first.verdict.success, first.verdict.reason
    assert other.verdict.success, other.verdict.reason


def test_the_robot_is_slow_in_a_speed_zone():
    corners = ((-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0))
    slow = run_episode(1001, zones=Zones([NavigationZone("slow", SPEED, corners, 0.2)]))
    assert slow.verdict.success, slow.verdict.reason
    assert slow.distance_driven / slow.simulated_seconds < 0.2


def test_delayed_scans_are_used_at_the_pose_of_their_stamp():
    run = run_episode(5, Fault("scan_late", start=8.0, strength=0.5))
    assert run.verdict.success, run.verdict.reason


def test_stopped_odometry_stays_implausible_while_the_robot_is_stopped():
    run = run_episode(5001, Fault("odometry_frozen", start=8.0))
    assert "trustworthy sensor (odometry: it stands still" in run.verdict.reason
    assert run.simulated_seconds < 60.0


@pytest.mark.parametrize("seed, start", [(1, 8.0), (1, 8.9), (5002, 8.0), (5013, 8.0)])
def test_a_robot_that_is_kidnapped_before_it_arrives_reports_no_false_delivery(seed, start):
    run = run_episode(seed, Fault("kidnapped", start=start, strength=0.5))
    assert run.verdict.success, run.verdict.reason


def test_a_mission_that_takes_too_long_fails_with_that_reason():
    errand = errand_mission(*load_pickup_and_dropoff(MAP / "zones.yaml"))
    world, grid = load_world(MAP / "home.world"), load_map(MAP / "home.yaml")
    run = HeadlessMission(world, robot_named("turtlebot_lidar"), grid, errand, seed=7).run(
        simulated_timeout=2.0
    )
    assert not run.verdict.success
    assert "not done within 2 simulated seconds" in run.verdict.reason


MISSION = """\
places:
  hall: {x: 1.2, y: 0.3}
  shelf: {x: 0.8, y: -0.8, approaches: [{x: 0.6, y: 0.1}]}
settings: {pickup_seconds: 0.5, retry_seconds: 0.2, order: shortest}
deliveries:
  - {object: cup, from: shelf, to: hall}
  - {object: book, from: hall, to: shelf}
"""


def test_a_mission_with_an_alternative_pose_is_repeated_bit_for_bit():
    world, grid = load_world(MAP / "home.world"), load_map(MAP / "home.yaml")
    robot, mission = robot_named("turtlebot_lidar"), parse_mission(MISSION, grid=grid)
    first, again = (HeadlessMission(world, robot, grid, mission, seed=1003).run(120.0) for _ in range(2))
    assert first.trajectory_hash == again.trajectory_hash
    assert first.verdict.success, first.verdict.reason
    assert [record.attempts for record in first.mission_record.deliveries] == [3, 3]


def test_the_page_of_faults_has_the_generated_text():
    page = Path(__file__).parents[3] / "docs" / "reports" / "faults.md"
    assert page.read_text("utf-8").endswith(TAIL)
