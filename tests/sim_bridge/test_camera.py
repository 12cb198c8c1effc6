#!/usr/bin/env python3
"""Topics of the TurtleBot's Kinect and IMU, as of gazebo_plugins."""

import math
import time
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import CameraInfo, Image, Imu, LaserScan, PointCloud2


def wait_for(topic, kind):
    return rospy.wait_for_message(topic, kind, 30.0)


class TestCamera(unittest.TestCase):
    def test_colour_pictures_come_with_their_calibration(self):
        picture, info = (
            wait_for("camera/rgb/image_raw", Image),
            wait_for("camera/rgb/camera_info", CameraInfo),
        )
        self.assertEqual((picture.width, picture.height, picture.encoding), (640, 480, "rgb8"))
        self.assertEqual((len(picture.data), picture.step), (640 * 480 * 3, 640 * 3))
        self.assertEqual(picture.header.frame_id, "camera_depth_optical_frame")
        self.assertAlmostEqual(info.K[0], 320.0 / math.tan(math.radians(30.0)), places=6)
        self.assertEqual((info.width, info.height, info.distortion_model), (640, 480, "plumb_bob"))
        pixels = np.frombuffer(picture.data, np.uint8).reshape(480, 640, 3)
        self.assertGreater(len(np.unique(pixels.reshape(-1, 3), axis=0)), 5, "more than one colour")

    def test_depth_pictures_points_and_scans_agree(self):
        depth, cloud = wait_for("camera/depth/image_raw", Image), wait_for("camera/depth/points", PointCloud2)
        scan = wait_for("scan", LaserScan)
        self.assertEqual((depth.encoding, depth.step), ("32FC1", 640 * 4))
        self.assertEqual((cloud.width, cloud.height, cloud.point_step), (640, 480, 32))
        metres = np.frombuffer(depth.data, np.float32).reshape(480, 640)
        points = np.frombuffer(cloud.data, np.float32).reshape(480, 640, 8)
        self.assertLessEqual(np.nanmax(metres), 5.0)
        self.assertGreaterEqual(np.nanmin(metres), 0.4)
        self.assertLess(np.nanmedian(np.abs(points[..., 2] - metres)), 1e-3, "the robot may have settled")
        middle = points[240]
        ranges = np.hypot(middle[:, 0], middle[:, 2])[::-1]
        bearings = np.arctan2(-middle[:, 0], middle[:, 2])[::-1]
        angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
        seen = np.isfinite(ranges)
        errors = np.abs(np.interp(bearings[seen], angles, scan.ranges) - ranges[seen])
        self.assertLess(np.nanmedian(errors), 0.01)

    def test_the_scan_is_that_of_depthimage_to_laserscan(self):
        scan, info = wait_for("scan", LaserScan), wait_for("camera/depth/camera_info", CameraInfo)
        self.assertEqual(scan.header.frame_id, "camera_depth_frame")
        self.assertEqual((len(scan.ranges), len(scan.intensities)), (640, 640))
        for value, expected in (
            (scan.angle_min, -math.radians(30.0)),
            (scan.angle_max, math.radians(30.0)),
            (scan.range_min, 0.45),
            (scan.range_max, 10.0),
            (scan.scan_time, 0.033),
            (scan.time_increment, 0.0),
        ):
            self.assertAlmostEqual(value, expected, places=5)
        self.assertLessEqual(np.nanmax(scan.ranges), 5.0)
        self.assertFalse(np.isinf(scan.ranges).any(), "what is not seen is not a number")
        self.assertEqual(info.header.frame_id, "camera_depth_optical_frame")
        self.assertEqual((info.P[0], info.P[3]), (info.K[0], 0.0))

    def test_pictures_and_scans_come_ten_times_a_second(self):
        for topic, kind in (("camera/depth/image_raw", Image), ("scan", LaserScan)):
            stamps = stamps_of(topic, kind, 6)
            steps = np.diff(stamps) / 0.1
            self.assertTrue(np.allclose(steps, np.round(steps)), f"{topic}: {steps}")
            self.assertGreater(steps.min(), 0.5)

    def test_the_inertial_sensor_feels_gravity(self):
        imu = wait_for("mobile_base/sensors/imu_data", Imu)
        self.assertEqual(imu.header.frame_id, "base_link")
        self.assertAlmostEqual(imu.linear_acceleration.z, 9.8, delta=0.2)
        self.assertAlmostEqual(imu.angular_velocity.z, 0.0, delta=0.01)

    def test_messages_that_a_slow_subscriber_loses_are_counted(self):
        slow = rospy.Subscriber(
            "camera/depth/points", PointCloud2, lambda message: time.sleep(1.0), queue_size=1
        )
        deadline, lost = time.monotonic() + 20.0, 0
        while not lost and time.monotonic() < deadline:
            lost = int(dropped_messages())
        slow.unregister()
        self.assertGreater(lost, 0)

    def test_nothing_is_rendered_without_subscribers(self):
        """Time passes faster without pictures: they are not taken."""
        with_pictures = rospy.Subscriber("camera/depth/points", PointCloud2, lambda message: None)
        wait_for("camera/depth/points", PointCloud2)
        slow = most_simulated()
        with_pictures.unregister()
        self.assertGreater(most_simulated(), 1.5 * slow)


def stamps_of(topic, kind, count):
    """Of so many messages in a row, s."""
    stamps = []
    subscriber = rospy.Subscriber(topic, kind, lambda message: stamps.append(message.header.stamp.to_sec()))
    deadline = time.monotonic() + 20.0
    while len(stamps) < count:
        assert time.monotonic() < deadline, f"too few messages on {topic}"
        time.sleep(0.01)
    subscriber.unregister()
    return stamps


def dropped_messages():
    for _ in range(10):  # also of the battery and the sensors
        for status in wait_for("/diagnostics", DiagnosticArray).status:
            values = {value.key: value.value for value in status.values}
            if "dropped_messages" in values:
                return values["dropped_messages"]
    raise AssertionError("no diagnostics of dropped messages")


def most_simulated():
    """Simulated seconds in half a second, when the machine had least else to do."""
    times = []
    for _ in range(7):
        times.append(rospy.get_time())
        time.sleep(0.5)
    return max(later - earlier for earlier, later in zip(times, times[1:]))


if __name__ == "__main__":
    rospy.init_node("camera_test")
    rostest.rosrun("home_service_tests", "camera", TestCamera)
