#!/usr/bin/env python3
"""The node slam_gmapping of slam_lite has the interface of gmapping 1.4, and services in addition."""

import itertools
import math
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
from nav_msgs.msg import MapMetaData
from rosgraph_msgs.msg import Log
from std_msgs.msg import Float64
from std_srvs.srv import SetBool
from tf2_msgs.msg import TFMessage
from toy_room import RESOLUTION, circle, room, sweep

from planar import OCCUPIED, Pose2, load_map
from planar_ros.calls.load_map import LoadMap
from planar_ros.messages.conversion import (
    GetMapArrays,
    LaserScanArrays,
    OccupancyGridArrays,
    frame_name,
    grid_from_msg,
    transform_msg,
)
from planar_ros.messages.transforms import Transforms

WAIT_SECONDS = 20.0
STEPS = 24
TRACKED, LATENESS = 0.06, rospy.Duration(0.15)


class SlamContractTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_slam_contract")
        cls.folder = Path(tempfile.mkdtemp())
        cls.truth = room()
        cls.transforms = Transforms()
        cls.scans = rospy.Publisher("scan", LaserScanArrays, queue_size=10)
        cls.log_texts = []
        rospy.Subscriber("/rosout", Log, lambda message: cls.log_texts.append(message.msg))
        cls.first_odom_in_map = cls.wait_for(lambda: cls.transforms.lookup("map", "odom"))
        cls.early_map = cls.call_dynamic_map()
        cls.wait_for(lambda: cls.scans.get_num_connections() > 0)
        for step in range(STEPS):
            cls.sense(step)
        cls.is_tracked = cls.wait_for(cls.tracks_standing_robot)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(str(cls.folder))

    @classmethod
    def tracks_standing_robot(cls):
        """Whether the last scan has been processed; it is sent again in case the node dropped it."""
        cls.sense(STEPS - 1)
        return cls.transforms.lookup("map", "base_link").distance_to(cls.base_in_map) < TRACKED

    @staticmethod
    def wait_for(condition):
        end = rospy.get_time() + WAIT_SECONDS
        while rospy.get_time() < end and not rospy.is_shutdown():
            found = condition()
            if found:
                return found
            rospy.sleep(0.05)
        raise AssertionError(f"not within {WAIT_SECONDS:g} s")

    @staticmethod
    def call_dynamic_map():
        rospy.wait_for_service("dynamic_map", WAIT_SECONDS)
        try:
            return rospy.ServiceProxy("dynamic_map", GetMapArrays)().map
        except rospy.ServiceException:
            return None

    @classmethod
    def sense(cls, step):
        """Publish the next scan of a circle, with odometry that turns 2 % too little."""
        cls.base_in_map = circle(0.15 * step)
        base_in_odom = Pose2(cls.base_in_map.x, cls.base_in_map.y, 0.147 * step)
        stamp = rospy.Time.now()
        scan = sweep(cls.truth, cls.base_in_map, stamp, "laser")
        scan.ranges[10], scan.ranges[20], scan.ranges[30] = np.nan, np.inf, 0.0
        cls.transforms.send(Pose2(), "base_link", "laser", stamp)
        cls.transforms.send(base_in_odom, "odom", "base_link", stamp)
        cls.scans.publish(scan)
        rospy.sleep(0.15)

    def call(self, service, path):
        return rospy.ServiceProxy("/slam_gmapping/" + service, LoadMap)(str(path))

    def newest_map(self):
        return rospy.wait_for_message("map", OccupancyGridArrays, WAIT_SECONDS)

    def test_map_to_odom_is_identity_before_the_first_scan(self):
        self.assertEqual(self.first_odom_in_map, Pose2())

    def test_dynamic_map_fails_before_the_first_map_and_then_answers(self):
        self.assertIsNone(self.early_map)
        self.assertEqual(frame_name(self.call_dynamic_map().header.frame_id), "map")

    def test_the_map_is_latched_three_valued_and_true(self):
        message = self.newest_map()
        self.assertEqual(set(np.unique(message.data)) - {-1, 0, 100}, set())
        self.assertEqual(message.info.map_load_time, rospy.Time(0))
        self.assertEqual((message.info.width % 32, message.info.height % 32), (0, 0))
        grid = grid_from_msg(message)
        walls_xy = self.truth.points_of(np.argwhere(self.truth.cells == OCCUPIED))
        mapped_xy = grid.points_of(np.argwhere(grid.cells == OCCUPIED))
        gaps = np.hypot(*(mapped_xy[:, None] - walls_xy[None]).transpose(2, 0, 1)).min(axis=1)
        self.assertGreater(len(mapped_xy), 200)
        self.assertLess(np.percentile(gaps, 95), 0.1)

    def test_metadata_and_entropy_are_latched(self):
        metadata = rospy.wait_for_message("map_metadata", MapMetaData, WAIT_SECONDS)
        self.assertAlmostEqual(metadata.resolution, RESOLUTION, places=6)
        self.assertGreater(rospy.wait_for_message("/slam_gmapping/entropy", Float64, WAIT_SECONDS).data, 0.0)

    def test_the_transform_corrects_odometry_and_is_post_dated(self):
        self.assertTrue(self.is_tracked)
        self.wait_for(lambda: self.transforms.latest_stamp("map", "odom") > rospy.Time.now() - LATENESS)

    @unittest.skipIf(LoadMap is None, "this nav_msgs has no LoadMap")
    def test_a_map_is_saved_and_a_bad_path_is_an_error_with_a_reason(self):
        self.call("save_map", self.folder / "room")
        self.assertGreater((load_map(self.folder / "room.yaml").cells == OCCUPIED).sum(), 200)
        with self.assertRaisesRegex(rospy.ServiceException, "cannot be written"):
            self.call("save_map", self.folder / "nowhere" / "room")

    @unittest.skipIf(LoadMap is None, "this nav_msgs has no LoadMap")
    def test_a_state_is_saved_and_loaded(self):
        path = self.folder / "room.npz"
        self.call("save_state", path)
        self.call("load_state", path)
        with self.assertRaisesRegex(rospy.ServiceException, "no such state file"):
            self.call("load_state", self.folder / "none.npz")

    def test_scans_are_dropped_during_a_pause(self):
        pause = rospy.ServiceProxy("/slam_gmapping/pause", SetBool)
        self.assertTrue(pause(True).success)
        before = self.newest_map().header.stamp
        for step in range(STEPS, STEPS + 10):
            self.sense(step)
        self.assertEqual(self.newest_map().header.stamp, before)
        self.assertTrue(pause(False).success)

    def test_a_scan_with_nan_angles_is_skipped_and_mapping_continues(self):
        stamp = rospy.Time.now()
        self.transforms.send(Pose2(), "base_link", "laser", stamp)
        self.transforms.send(circle(0.0), "odom", "base_link", stamp)
        scan = sweep(self.truth, circle(0.0), stamp, "laser")
        scan.angle_increment = math.nan
        self.scans.publish(scan)
        words = "skipping a scan: a scan with invalid angle_increment nan"
        self.wait_for(lambda: words in self.log_texts)
        before = self.newest_map().header.stamp
        steps = itertools.count(STEPS)

        def is_newer():
            self.sense(next(steps))
            return self.newest_map().header.stamp > before

        self.wait_for(is_newer)

    def test_a_laser_that_is_not_mounted_planar_is_refused(self):
        before = self.newest_map().header.stamp
        stamp = rospy.Time.now()
        tilted = transform_msg(Pose2(), "base_link", "tilted", stamp)
        tilted.transform.rotation.x = tilted.transform.rotation.w = math.sqrt(0.5)
        rospy.Publisher("/tf", TFMessage, queue_size=1, latch=True).publish(TFMessage([tilted]))
        self.transforms.send(circle(0.0), "odom", "base_link", stamp)
        self.scans.publish(sweep(self.truth, circle(0.0), stamp, "tilted"))
        reason = "Z-coordinate has to be 1 or -1, but gave: 0.00000 (frame tilted)"
        self.wait_for(lambda: f"Laser has to be mounted planar! {reason}" in self.log_texts)
        self.assertEqual(self.newest_map().header.stamp, before)

    def test_an_invalid_parameter_ends_the_node_and_is_named(self):
        run = subprocess.run(
            ["rosrun", "slam_lite", "slam_gmapping", "__name:=other", "_delta:=0"],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=30.0,
            check=False,
        )
        self.assertEqual(run.returncode, 2)
        self.assertIn("/other/delta must be", run.stdout.decode())


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "slam_contract", SlamContractTest)
