"""Each robot drives into the next room with its preset, without a collision."""

from pathlib import Path

import pytest

from headless_mission.navigation import NavigationHooks
from move_base_lite import Status, load_settings
from planar import Pose2, load_map
from sim_bridge import ROBOTS, Episode, EpisodeHooks, Simulation, load_world

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
    navigation = NavigationHooks(settings, grid)
    navigation.poses.set_odom_in_map(Pose2())  # odometry drifts little over so few metres
    navigation.move_base.set_goal(NEXT_ROOM)
    drive = Drive(navigation)
    episode = Episode(simulation, navigation.period, hooks=(drive, navigation))
    try:
        step = episode.run(lambda: drive.is_over)
    finally:
        simulation.close()
    off_by = step.base_in_world.distance_to(NEXT_ROOM)
    print(f"{robot}: {step.stamp:.1f} s, at most {drive.fastest:.2f} m/s, {off_by:.3f} m off")
    decision = navigation.result.decision
    assert decision.status is Status.SUCCEEDED, decision.text
    assert drive.touched == set()
    assert off_by < settings.controller.xy_goal_tolerance + 0.1
    assert 0.8 * settings.controller.max_vel_x < drive.fastest < 1.1 * settings.controller.max_vel_x


class Drive(EpisodeHooks):
    """What was touched, the highest speed, and whether the goal has ended or 90 s have passed."""

    def __init__(self, navigation):
        self._navigation, self.touched, self.fastest, self._stamp = navigation, set(), 0.0, 0.0

    @property
    def is_over(self):
        return self._navigation.result.decision.status.is_final or self._stamp > 90.0

    def after_step(self, episode, step):
        self.touched.update(step.contacts)
        self.fastest, self._stamp = max(self.fastest, step.odometry.twist.v), step.stamp
