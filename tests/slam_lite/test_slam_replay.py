#!/usr/bin/env python3
"""slam_lite_replay maps bags without a master, intact and broken ones."""

import math
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rosbag
import rospy
import rostest
from bad_scans import BROKEN, break_scans
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage
from toy_room import circle, room

from planar import OCCUPIED, Pose2, load_map
from planar.geometry.ray_casting import cast_rays
from planar_ros.messages.conversion import transform_msg

SCANS, START, PERIOD = 120, 1000.0, 0.2
LASER_IN_BASE = Pose2(0.1, 0.0, 0.0)


def base_at(i: int) -> Pose2:
    return circle(0.05 * i)


def write_bag(
    path,
    scans=True,
    transforms=True,
    back_at=None,
    back_by=0.5,
    range_max=20.0,
    base="base_link",
    at=base_at,
):
    """A bag of a drive round the room; at scan ``back_at`` the stamp goes back by so many seconds."""
    grid = room()
    angles = np.linspace(-math.pi / 2.0, math.pi / 2.0, 181)
    with rosbag.Bag(str(path), "w", chunk_threshold=20000) as bag:
        for i in range(SCANS):
            recorded = rospy.Time.from_sec(START + PERIOD * i)
            if transforms:
                odom = transform_msg(at(i), "odom", base, recorded)
                laser = transform_msg(LASER_IN_BASE, base, "laser", recorded)
                bag.write("/tf", TFMessage([odom, laser]), recorded)
            if scans:
                scan = LaserScan()
                scan.header.frame_id = "laser"
                scan.header.stamp = recorded - rospy.Duration(back_by if i == back_at else 0.0)
                scan.angle_min, scan.angle_increment = angles[0], angles[1] - angles[0]
                scan.range_min, scan.range_max = 0.1, range_max
                scan.ranges = cast_rays(grid, at(i) @ LASER_IN_BASE, angles, 20.0).tolist()
                bag.write("/scan", scan, recorded)
    return path


class SlamReplayTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, str(self.folder))
        self.bag, self.map = self.folder / "drive.bag", self.folder / "map"
        self.trajectory = self.folder / "drive.tum"

    def replay(self, *arguments):
        """Exit code and output; the URI is of a master that does not exist, as none is needed."""
        command = ["rosrun", "slam_lite", "slam_lite_replay", self.bag, "--map", self.map]
        run = subprocess.run(
            [*map(str, command), "--trajectory", str(self.trajectory), *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=60.0,
            check=False,
            env={**os.environ, "ROS_MASTER_URI": "http://127.0.0.1:1"},
        )
        return run.returncode, run.stdout.decode()

    def poses(self):
        rows = np.loadtxt(str(self.trajectory), ndmin=2)
        return [Pose2(x, y, 2.0 * math.atan2(z, w)) for _, x, y, _, _, _, z, w in rows]

    def assert_mapped(self):
        self.assertGreater((load_map(self.map.with_suffix(".yaml")).cells == OCCUPIED).sum(), 150)

    def test_a_bag_becomes_a_map_and_a_pose_for_every_scan(self):
        write_bag(self.bag)
        self.assertEqual(self.replay()[0], 0)
        self.assert_mapped()
        poses = self.poses()
        self.assertEqual(len(poses), SCANS)
        start = base_at(0).inverse()
        for i, laser_in_map in enumerate(poses):
            self.assertLess(laser_in_map.distance_to(start @ base_at(i) @ LASER_IN_BASE), 0.05)

    def test_the_base_can_be_asked_for_instead_of_the_laser(self):
        write_bag(self.bag)
        self.replay("--pose-of", "base")
        self.assertLess(self.poses()[0].distance_to(base_at(0)), 1e-3)

    def test_the_same_bag_gives_the_same_files(self):
        write_bag(self.bag)
        self.replay()
        first = self.trajectory.read_bytes(), self.map.with_suffix(".pgm").read_bytes()
        self.replay()
        self.assertEqual((self.trajectory.read_bytes(), self.map.with_suffix(".pgm").read_bytes()), first)

    def test_a_bag_without_scans_is_an_error_that_names_its_topics(self):
        write_bag(self.bag, scans=False)
        code, text = self.replay()
        self.assertEqual(code, 1)
        self.assertIn(f"error: {self.bag}: no scans on /scan; topics: /tf\n", text)

    def test_a_scan_without_a_valid_reading_is_no_map(self):
        write_bag(self.bag, range_max=0.0)
        code, text = self.replay()
        self.assertEqual(code, 1)
        self.assertIn(f"error: {self.bag}: no reading on /scan is valid", text)
        self.assertFalse(self.map.with_suffix(".pgm").exists())

    def test_a_robot_that_does_not_move_gives_no_useful_map(self):
        write_bag(self.bag, at=lambda i: base_at(0))
        code, text = self.replay()
        self.assertEqual(code, 1)
        self.assertIn(f"warning: {self.bag}: the robot did not move", text)

    def test_the_frames_that_are_used_are_printed(self):
        write_bag(self.bag, base="base_footprint")
        code, text = self.replay()
        self.assertEqual(code, 0)
        self.assertIn(
            f"warning: {self.bag}: odometry is odom -> base_footprint, as no transform odom -> base_link was "
            "recorded\n",
            text,
        )
        self.assertIn("scans of /scan (laser), odometry odom -> base_footprint\n", text)
        self.assert_mapped()

    def test_a_bag_without_transforms_is_mapped_from_the_scans_with_a_warning(self):
        write_bag(self.bag, transforms=False)
        code, text = self.replay()
        self.assertEqual(code, 0)
        for sentence in (
            "no transform odom -> base_link (frames: none), assuming a stationary base",
            "no transform base_link -> laser, assuming the laser at the origin of base_link",
        ):
            self.assertIn(f"warning: {self.bag}: {sentence}, at stamp 1000.000, 0 % into the bag\n", text)
        self.assert_mapped()

    def test_a_jump_back_in_time_is_reported_with_its_position(self):
        write_bag(self.bag, back_at=60)
        code, text = self.replay()
        self.assertEqual(code, 0)
        self.assertIn(
            f"warning: {self.bag}: time goes back by 0.300 s, at stamp 1011.500, 50 % into the bag\n", text
        )
        self.assertEqual(len(self.poses()), SCANS - 1)

    def test_mapping_continues_after_a_jump_back_as_of_a_looped_bag(self):
        write_bag(self.bag, back_at=60, back_by=30.0)
        code, text = self.replay()
        self.assertEqual(code, 0)
        self.assertIn(
            f"warning: {self.bag}: time goes back by 29.800 s, at stamp 982.000, 50 % into the bag\n", text
        )
        self.assert_mapped()

    def test_invalid_scans_are_skipped_with_a_warning(self):
        """They once ended the program by a signal."""
        write_bag(self.folder / "whole.bag")
        break_scans(self.folder / "whole.bag", self.bag)
        code, text = self.replay()
        self.assertEqual(code, 0, text)
        self.assertIn(f"{self.bag}: skipping a scan (a scan with invalid angle_increment nan)", text)
        self.assertEqual(len(self.poses()), SCANS - BROKEN)
        self.assert_mapped()

    def test_a_bag_that_is_cut_off_is_mapped_up_to_there(self):
        write_bag(self.bag)
        whole = self.bag.read_bytes()
        self.bag.write_bytes(whole[: int(0.7 * len(whole))])
        code, text = self.replay()
        self.assertEqual(code, 1)
        self.assertRegex(text, rf"warning: {self.bag}: cut off \d+\.\d s after its start\n")
        self.assertGreater(len(self.poses()), SCANS // 3)
        self.assert_mapped()

    def test_a_bag_that_is_broken_in_the_middle_is_mapped_up_to_there(self):
        write_bag(self.bag)
        whole = bytearray(self.bag.read_bytes())
        middle = len(whole) // 2
        whole[middle : middle + 8000] = b"\xff" * 8000
        self.bag.write_bytes(bytes(whole))
        code, text = self.replay()
        self.assertEqual(code, 1)
        self.assertRegex(text, rf"warning: {self.bag}: broken \d+\.\d s after its start \(.+\)\n")
        self.assert_mapped()

    def test_a_file_that_is_no_bag_is_an_error(self):
        for content in (b"", b"not a bag\n", b"#ROSBAG V2.0\n"):
            self.bag.write_bytes(content)
            code, text = self.replay()
            self.assertEqual(code, 2, content)
            self.assertRegex(text, "^error: .*drive.bag: ")
        self.bag.unlink()
        self.assertRegex(self.replay()[1], "error: .*No such file")

    def test_an_unwritable_file_is_an_error_and_the_others_are_written(self):
        write_bag(self.bag)
        self.trajectory = self.folder / "nowhere" / "drive.tum"
        code, text = self.replay()
        self.assertEqual(code, 2)
        self.assertIn(f"error: {self.trajectory}: cannot be written (No such file or directory)\n", text)
        self.assert_mapped()


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "slam_replay", SlamReplayTest)
