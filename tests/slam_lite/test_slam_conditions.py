#!/usr/bin/env python3
"""The node slam_gmapping in unusual conditions; each robot has its own tf topic."""

import math
import shutil
import subprocess
import tempfile
import unittest
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import psutil
import rospy
import rostest
from rosgraph_msgs.msg import Log
from roslib.packages import find_node
from tf2_msgs.msg import TFMessage
from toy_room import circle, room, sweep

from planar import Pose2
from planar_ros.calls.load_map import LoadMap
from planar_ros.messages.conversion import LaserScanArrays, frame_name, transform_msg, yaw_of

STEPS, STEP = 24, 0.15
# Scans at the end of a drive, so that the queue drops scans whose transform does not arrive.
STAND = 6
WAIT_SECONDS = 20.0
TRACKED = 0.06


class Robot:
    """Drives a circle and publishes its scans and transforms to slam_gmapping in the namespace ``name``."""

    def __init__(
        self, name: str, has_odometry: bool = True, upside_down: bool = False, changes_beams: bool = False
    ):
        self.name = name
        self.odom_in_map = Pose2()
        self._has_odometry, self._upside_down, self._changes_beams = has_odometry, upside_down, changes_beams
        self._scans = rospy.Publisher(f"/{name}/scan", LaserScanArrays, queue_size=10)
        self._tf = rospy.Publisher(f"/{name}/tf", TFMessage, queue_size=10)
        rospy.Subscriber(f"/{name}/tf", TFMessage, self._on_tf)
        self.is_mapped = False
        rospy.Subscriber(f"/{name}/map", rospy.AnyMsg, self._on_map)

    @property
    def is_connected(self) -> bool:
        return self._scans.get_num_connections() > 0 and self._tf.get_num_connections() > 1

    def sense(self, grid, step: int, stamp):
        self.base_in_map = circle(STEP * step)
        self.base_in_odom = circle(0.98 * STEP * step) if self._has_odometry else Pose2()
        mount = transform_msg(Pose2(), "base_link", "laser", stamp)
        if self._upside_down:
            mount.transform.rotation.x, mount.transform.rotation.w = 1.0, 0.0
        transforms = [mount]
        if self._has_odometry:
            transforms.append(transform_msg(self.base_in_odom, "odom", "base_link", stamp))
        self._tf.publish(TFMessage(transforms))
        beams = 180 if self._changes_beams and step % 3 == 0 else 360
        self._scans.publish(sweep(grid, self.base_in_map, stamp, "laser", beams, self._upside_down))

    def publish(self, scan):
        """Publish a scan of the laser, with its mounting."""
        self._tf.publish(TFMessage([transform_msg(Pose2(), "base_link", "laser", scan.header.stamp)]))
        self._scans.publish(scan)

    @property
    def error(self) -> float:
        """Error of the node's estimate [m]."""
        return (self.odom_in_map @ self.base_in_odom).distance_to(self.base_in_map)

    def _on_map(self, message):
        self.is_mapped = True

    def _on_tf(self, message):
        for transform in message.transforms:
            if frame_name(transform.child_frame_id) == "odom":
                moved = transform.transform.translation
                self.odom_in_map = Pose2(moved.x, moved.y, yaw_of(transform.transform.rotation))


class SlamConditionsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_slam_conditions")
        cls.folder, cls.grid, cls.log = Path(tempfile.mkdtemp()), room(), []
        rospy.Subscriber("/rosout", Log, lambda message: cls.log.append((message.name, message.msg)))
        cls.plain = Robot("plain")
        cls.robots = [
            cls.plain,
            Robot("hanging", upside_down=True),
            Robot("changing", changes_beams=True),
            Robot("lost", has_odometry=False),
        ]
        cls.drive(cls.robots, 0)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(str(cls.folder))

    @classmethod
    def wait_for(cls, condition, what):
        end = rospy.get_time() + WAIT_SECONDS
        while not condition():
            if rospy.get_time() > end or rospy.is_shutdown():
                raise AssertionError(f"{what} did not happen within {WAIT_SECONDS:g} s")
            rospy.sleep(0.05)

    @classmethod
    def drive(cls, robots, first, earlier=0.0):
        """Publish STEPS scans from step ``first`` on, with stamps ``earlier`` seconds in the past.

        The robots stand still until each has a map, whose origin is the pose of the first scan.
        """
        cls.wait_for(lambda: all(robot.is_connected for robot in robots), "the nodes")

        def sense_all(step):
            for robot in robots:
                robot.sense(cls.grid, step, rospy.Time.now() - rospy.Duration(earlier))
            rospy.sleep(0.1)
            return all(robot.is_mapped for robot in robots)

        cls.wait_for(lambda: sense_all(first), "a map of each")
        for step in range(first, first + STEPS + STAND):
            sense_all(min(step, first + STEPS - 1))

    def robot(self, name) -> Robot:
        return next(robot for robot in self.robots if robot.name == name)

    def call(self, name, service, path):
        proxy = rospy.ServiceProxy(f"/{name}/slam_gmapping/{service}", LoadMap)
        proxy.wait_for_service(WAIT_SECONDS)
        return proxy(str(path))

    def assert_tracked(self, robot):
        """After the node has processed the last scans."""
        self.wait_for(lambda: robot.error < TRACKED, f"tracking of {robot.name}")

    def has_logged(self, name, text):
        return any(node == f"/{name}/slam_gmapping" and text in line for node, line in self.log)

    def test_a_laser_upside_down_is_read_the_right_way_round(self):
        self.assert_tracked(self.robot("hanging"))

    def test_the_number_of_beams_may_change_from_scan_to_scan(self):
        self.assert_tracked(self.robot("changing"))

    def test_without_odometry_scans_are_matched_and_the_missing_transform_is_named(self):
        self.assert_tracked(self.robot("lost"))
        text = "no odometry (no transform odom -> base_link): mapping from the scans alone"
        self.wait_for(lambda: self.has_logged("lost", text), "a warning")

    def test_without_odometry_a_scan_with_nan_angles_is_skipped(self):
        lost = self.robot("lost")
        words = "skipping a scan: a scan with invalid angle_increment nan"

        def is_logged():
            scan = sweep(self.grid, lost.base_in_map, rospy.Time.now(), "laser")
            scan.angle_increment = math.nan
            lost.publish(scan)
            return ("/lost/slam_gmapping", words) in self.log

        self.wait_for(is_logged, "a warning")

    def test_mapping_goes_on_after_time_has_gone_back(self):
        robot = self.robot("changing")
        self.drive([robot], STEPS, earlier=100.0)
        self.assert_tracked(robot)
        self.wait_for(lambda: self.has_logged("changing", "time has jumped back"), "a warning")

    @unittest.skipIf(LoadMap is None, "this nav_msgs has no LoadMap")
    def test_a_saved_state_can_be_localized_in_and_stays_as_it_is(self):
        state, again = self.folder / "state.npz", self.folder / "again.npz"
        self.call("plain", "save_state", state)
        with self.localizer_in(state):
            localizer = Robot("localizer")
            self.drive([localizer], STEPS)
            self.assert_tracked(localizer)
            self.call("localizer", "save_state", again)
        first, second = (np.load(str(path))["poses"] for path in (state, again))
        np.testing.assert_array_equal(first, second)

    @unittest.skipIf(LoadMap is None, "this nav_msgs has no LoadMap")
    def test_a_full_disk_is_an_error_and_leaves_the_old_files_as_they_are(self):
        state, stem = self.folder / "full.npz", self.folder / "full"
        self.call("plain", "save_state", state)
        with self.localizer_in(state) as node:
            self.call("localizer", "save_map", stem)
            files = sorted(self.folder.glob("full.*"))
            self.assertEqual(len(files), 3)
            before = [path.read_bytes() for path in files]
            # Writing more than this fails as on a full disk.
            psutil.Process(node.pid).rlimit(psutil.RLIMIT_FSIZE, (1000, 1000))
            for service, path, file in (("save_map", stem, "full.pgm"), ("save_state", state, "full.npz")):
                with self.assertRaisesRegex(rospy.ServiceException, f"{file}: cannot be written"):
                    self.call("localizer", service, path)
        self.assertEqual(sorted(self.folder.glob("full.*")), files)
        self.assertEqual([path.read_bytes() for path in files], before)

    @contextmanager
    def localizer_in(self, state):
        """A node that localizes in a state, with stdout and stderr on a full disk."""
        command = [find_node("slam_lite", "slam_gmapping")[0], f"_state:={state}", "_localization_only:=true"]
        remaps = ["__ns:=/localizer", "/tf:=/localizer/tf", "__name:=slam_gmapping"]
        with Path("/dev/full").open("w") as full:
            node = subprocess.Popen([*command, *remaps], stdout=full, stderr=full)
        try:
            rospy.wait_for_service("/localizer/slam_gmapping/save_map", WAIT_SECONDS)
            yield node
        finally:
            node.terminate()
            node.wait(WAIT_SECONDS)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "slam_conditions", SlamConditionsTest)
