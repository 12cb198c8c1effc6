#!/usr/bin/env python3
"""The nine behaviours of amcl's regression tests, on bags of the simulated robot.

amcl's tests allow 0.75 m and 0.75 rad, these 0.15 m and 0.1 rad. They can run the official amcl too, if
installed: ``rostest tests/amcl_lite/reference_behaviours.test amcl_pkg:=amcl``.
"""

import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
import yaml
from bag_environment import BagEnvironment

from planar import Pose2, wrap
from sim_bridge import load_world
from sim_bridge.views.true_map import true_map

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "benchmarks"))

from helpers.bags import Laser, write_bag  # noqa: E402
from helpers.drives import Crazy, RandomDriver, Tour, drive  # noqa: E402
from helpers.worlds import HALLWAY, OFFICE, world_from_picture  # noqa: E402

# Tolerances of the pose at the end of a bag [m, rad].
NEAR, NEAR_ANGLE = 0.15, 0.1
HOME_LOOP = ((2.0, 3.0), (-2.0, 1.0), (0.0, 0.0))
TWO_LASERS = (Laser("front", Pose2(0.15, 0.0, 0.0)), Laser("rear", Pose2(-0.15, 0.05, np.pi), True))


class DriveWorld:
    """A world, its map, and the robot's start pose."""

    def __init__(self, world, start=Pose2()):
        self.world, self.start = world, start
        self.grid = true_map(world, inside=(start.x, start.y))

    def drive(self, driver, seconds, seed):
        return drive(self.world, driver, seed, seconds, start=self.start)


class ReferenceBehavioursTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_reference_behaviours")
        cls.home = DriveWorld(load_world(str(ROOT / "map" / "home.world")))
        cls.office = DriveWorld(world_from_picture("office", OFFICE), Pose2(1.0, 1.0))
        cls.hallway = DriveWorld(world_from_picture("hallway", HALLWAY), Pose2(2.0, 3.75))
        cls.node = BagEnvironment(rospy.get_param("~amcl_pkg"))
        cls.parameters = yaml.safe_load((ROOT / "src/amcl_lite/config/turtlebot.yaml").read_text())
        cls.folder = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.node.stop_node()
        cls.folder.cleanup()

    def drive_about(self, seconds, seed):
        return self.home.drive(RandomDriver(self.home.grid, np.random.default_rng(seed)), seconds, seed)

    def assert_localized(self, world, observations, start, actions={}, **recording):
        """Play a drive to a node with the initial pose ``start`` and check its last estimate."""
        path = str(Path(self.folder.name) / "drive.bag")
        write_bag(path, observations, **recording)
        names = ("initial_pose_x", "initial_pose_y", "initial_pose_a")
        self.node.start_node(world.grid, {**self.parameters, **dict(zip(names, start.as_array().tolist()))})
        final = self.node.play(path, actions)
        self.assertIsNotNone(final.found, "the node has published no pose")
        distance = final.found.distance_to(final.truth)
        angle = abs(wrap(final.found.yaw - final.truth.yaw))
        print(f"{self.id().rsplit('.')[-1]}: {distance:.3f} m, {angle:.3f} rad")
        self.assertLess(distance, NEAR)
        self.assertLess(angle, NEAR_ANGLE)

    def test_set_initial_pose(self):
        observations = self.drive_about(20.0, seed=1)
        actions = {1.0: lambda stamp: self.node.publish_initial_pose(observations[9].base_in_map, stamp)}
        self.assert_localized(self.home, observations, Pose2(-3.0, 2.0, 1.0), actions)

    def test_set_initial_pose_delayed(self):
        observations = self.drive_about(20.0, seed=1)

        def publish_late(stamp):
            self.node.publish_initial_pose(observations[29].base_in_map, stamp - rospy.Duration(3.0))

        self.assert_localized(self.home, observations, Pose2(-3.0, 2.0, 1.0), {6.0: publish_late})

    def test_basic_localization_stage(self):
        self.assert_localized(self.home, self.drive_about(40.0, seed=2), Pose2(0.2, -0.2, 0.2))

    def test_global_localization_stage(self):
        actions = {0.5: lambda stamp: self.node.localize_globally()}
        self.assert_localized(self.home, self.drive_about(60.0, seed=3), Pose2(-3.0, 2.0, 1.0), actions)

    def test_small_loop_prf(self):
        observations = self.home.drive(Tour(self.home.grid, *HOME_LOOP), 45.0, seed=4)
        self.assert_localized(self.home, observations, Pose2())

    def test_small_loop_crazy_driving_prg(self):
        observations = self.home.drive(Crazy(Tour(self.home.grid, *HOME_LOOP)), 45.0, seed=5)
        self.assert_localized(self.home, observations, Pose2())

    def test_texas_greenroom_loop(self):
        tour = Tour(self.office.grid, (11.5, 1.0), (11.5, 7.0), (1.0, 7.2), (1.0, 1.0))
        observations = self.office.drive(tour, 75.0, seed=6)
        self.assert_localized(self.office, observations, self.office.start)

    def test_rosie_multilaser(self):
        observations = self.drive_about(40.0, seed=7)
        self.assert_localized(self.home, observations, Pose2(), grid=self.home.grid, lasers=TWO_LASERS)

    def test_texas_willow_hallway_loop(self):
        tour = Tour(self.hallway.grid, (20.0, 3.75), (2.0, 3.75))
        observations = self.hallway.drive(tour, 80.0, seed=8)
        self.assert_localized(self.hallway, observations, self.hallway.start)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "reference_behaviours", ReferenceBehavioursTest)
