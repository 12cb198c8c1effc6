"""The topics of a robot's cameras and inertial sensors: they measure only while somebody has subscribed."""

from typing import Callable

import rospy
from geometry_msgs.msg import Quaternion, Vector3
from sensor_msgs.msg import Imu

from sim_bridge.description.profile import ImuProfile
from sim_bridge.geometry.pose3 import quaternion
from sim_bridge.ros.camera_topics import CameraTopics
from sim_bridge.ros.messages import covariance_of
from sim_bridge.scene import Scene
from sim_bridge.sensors.imu import ImuReading

QUEUE_SIZE = 100


class SensorTopics:
    """``publisher`` makes one of a topic, a type and a queue length; ``frame_of`` prefixes a frame's name."""

    def __init__(
        self,
        scene: Scene,
        name: str,
        publisher: Callable[[str, type, int], rospy.Publisher],
        frame_of: Callable[[str], str],
    ):
        self._scene = scene
        self._name = name
        profile = scene.robot(name).profile
        self._cameras = [
            (CameraTopics(camera, frame_of(camera.frame), publisher), self._steps_of(camera.rate))
            for camera in profile.cameras
        ]
        self._imus = [
            (publisher(imu.topic, Imu, QUEUE_SIZE), imu, self._steps_of(_rate_of(imu, scene)))
            for imu in profile.imus
        ]
        self._frame_of = frame_of

    def publish(self, steps: int, stamp: rospy.Time) -> None:
        """What is due after that many steps of the scene."""
        for number, (topics, period) in enumerate(self._cameras):
            if steps % period == 0 and topics.are_wanted():
                topics.publish(self._scene.picture(self._name, number), stamp)
                self._warn()
        for number, (topic, imu, period) in enumerate(self._imus):
            if steps % period == 0 and topic.get_num_connections():
                reading = self._scene.inertia(self._name, number, period * self._scene.step_seconds)
                message = _imu_msg(reading, imu)
                message.header.stamp, message.header.frame_id = stamp, self._frame_of(imu.frame)
                topic.publish(message)

    def _warn(self) -> None:
        """Says once what the cameras cannot see."""
        for text in self._scene.unseen:
            rospy.logwarn_once(text)

    def _steps_of(self, rate: float) -> int:
        return max(round(1.0 / self._scene.step_seconds / rate), 1)


def _rate_of(imu: ImuProfile, scene: Scene) -> float:
    return imu.rate or scene.settings.odometry_rate


def _imu_msg(reading: ImuReading, imu: ImuProfile) -> Imu:
    return Imu(
        orientation=Quaternion(*quaternion(reading.orientation)),
        orientation_covariance=covariance_of(imu.orientation_variances),
        angular_velocity=Vector3(*reading.turn_rates),
        angular_velocity_covariance=covariance_of(imu.turn_variances),
        linear_acceleration=Vector3(*reading.acceleration),
        linear_acceleration_covariance=covariance_of(imu.acceleration_variances),
    )
