"""An inertial sensor's topic."""

import rospy
from geometry_msgs.msg import Quaternion, Vector3
from sensor_msgs.msg import Imu

from sim_bridge.geometry.pose3 import quaternion
from sim_bridge.ros.messages import covariance_of
from sim_bridge.ros.outlet import Outlet
from sim_bridge.sensors.imu import ImuProfile, ImuReading

QUEUE_SIZE = 100


class ImuTopic:
    """Readings, measured only while somebody has subscribed."""

    def __init__(self, profile: ImuProfile, outlet: Outlet):
        self._profile = profile
        self._frame = outlet.frame(profile.frame)
        self._publisher = outlet.publisher(profile.topic, Imu, QUEUE_SIZE)

    def are_wanted(self) -> bool:
        return self._publisher.get_num_connections() > 0

    def publish(self, reading: ImuReading, stamp: rospy.Time) -> None:
        message = Imu(
            orientation=Quaternion(*quaternion(reading.orientation)),
            orientation_covariance=covariance_of(self._profile.orientation_variances),
            angular_velocity=Vector3(*reading.turn_rates),
            angular_velocity_covariance=covariance_of(self._profile.turn_variances),
            linear_acceleration=Vector3(*reading.acceleration),
            linear_acceleration_covariance=covariance_of(self._profile.acceleration_variances),
        )
        message.header.stamp, message.header.frame_id = stamp, self._frame
        self._publisher.publish(message)
