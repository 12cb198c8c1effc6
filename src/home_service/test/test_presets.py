"""Each robot drives into the next room with its preset, without a collision."""

from pathlib import Path

import pytest

from move_base_lite import Navigator, Status, load_settings
from planar import Pose2, load_map
from sim_bridge import ROBOTS, Simulation, load_world

ROOT = Path(__file__).resolve().parents[3]
CONFIG = ROOT / "src" / "move_base_lite" / "config"
NEXT_ROOM = Pose2(2.0, 3.0, 1.0)
PRESETS = {
    "turtlebot_lidar": ["turtlebot.yaml"],
    "turtlebot_kinect": ["turtlebot.yaml", "turtlebot_kinect.yaml"],
    "turtlebot3_burger": ["turtlebot.yaml", "turtlebot3_burger.yaml"],
    "turtlebot3_waffle": ["turtlebot.yaml", "turtlebot3_waffle.yaml"],
    "jackal": ["jackal.yaml"],
}


@pytest.fixture(scope="module")
def home():
    return load_world(ROOT / "map" / "home.world"), load_map(ROOT / "map" / "home.yaml")


@pytest.mark.parametrize("robot", PRESETS)
def test_a_robot_gets_into_the_next_room_with_its_preset(robot, home):
    world, grid = home
    settings = load_settings(*(CONFIG / name for name in PRESETS[robot]))
    simulation = Simulation(world, ROBOTS[robot], seed=1)
    navigator = Navigator(settings, grid)
    navigator.set_goal(NEXT_ROOM)
    try:
        seconds, touched, fastest = drive(simulation, navigator, settings.move_base.controller_frequency)
        off_by = simulation.step().base_in_world.distance_to(NEXT_ROOM)
    finally:
        simulation.close()
    print(f"{robot}: {seconds:.1f} s, at most {fastest:.2f} m/s, {off_by:.3f} m off")
    assert touched == set()
    assert off_by < settings.controller.xy_goal_tolerance + 0.1
    assert 0.8 * settings.controller.max_vel_x < fastest < 1.1 * settings.controller.max_vel_x


def drive(simulation, navigator, rate):
    """Simulated seconds until the goal is reached, what was touched, and the highest speed."""
    steps, command, scan, touched, fastest = (
        round(1.0 / rate / simulation.step_seconds),
        None,
        None,
        set(),
        0.0,
    )
    for _ in range(round(90.0 * rate)):
        for _ in range(steps):
            seen = simulation.step(command)
            command, scan = None, seen.scan or scan
            touched.update(seen.contacts)
        if scan is None:
            continue
        odometry, fastest = seen.odometry, max(fastest, seen.odometry.twist.v)
        # Odometry drifts little over so few metres.
        decision = navigator.tick(
            seen.stamp, odometry.base_in_odom, odometry.base_in_odom, odometry.twist, scan
        )
        command, scan = decision.command, None
        if decision.status.is_final:
            assert decision.status is Status.SUCCEEDED, decision.text
            return seen.stamp, touched, fastest
    raise AssertionError("not there after 90 s")
