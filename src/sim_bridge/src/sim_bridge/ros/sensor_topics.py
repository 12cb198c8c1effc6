"""What ROS makes of sensors: which topics a description's sensor has, and the contract of such topics."""

from typing import Any, Callable, Dict, List, Protocol, Tuple

import rospy

from planar_ros.messages.conversion import time_of
from sim_bridge.robot import Observation, Robot
from sim_bridge.ros.camera_topics import CameraTopics
from sim_bridge.ros.imu_topic import ImuTopic
from sim_bridge.ros.kobuki_topics import KobukiTopics
from sim_bridge.ros.laser_topic import LaserTopic
from sim_bridge.ros.outlet import Outlet
from sim_bridge.sensors.camera import CameraProfile
from sim_bridge.sensors.imu import ImuProfile
from sim_bridge.sensors.kobuki import KobukiProfile
from sim_bridge.sensors.lidar import LaserProfile


class SensorTopics(Protocol):
    """The topics of one sensor; made of its spec and an Outlet, which opens them."""

    def are_wanted(self) -> bool:
        """Whether anybody has subscribed; a sensor that takes long measures only then."""

    def publish(self, value: Any, stamp: rospy.Time) -> None:
        """Tells what was measured at ``stamp`` to those who have subscribed."""


# By the class of a sensor's spec (see sim_bridge.sensors.registry).
TOPICS: Dict[type, Callable[[Any, Outlet], SensorTopics]] = {
    LaserProfile: LaserTopic,
    CameraProfile: CameraTopics,
    ImuProfile: ImuTopic,
    KobukiProfile: KobukiTopics,
}


class RobotSensors:
    """The topics of all sensors of a robot's description."""

    def __init__(self, robot: Robot, outlet: Outlet):
        self._robot = robot
        self._topics: List[Tuple[str, SensorTopics]] = [
            (name, TOPICS[type(spec)](spec, outlet))
            for name, spec in robot.specs.items()
            if type(spec) in TOPICS
        ]

    def ask(self) -> None:
        """Before a step: what takes long is measured only if it is wanted."""
        for name, topics in self._topics:
            self._robot.want(name, topics.are_wanted())

    def publish(self, observation: Observation) -> None:
        for name, topics in self._topics:
            reading = observation.readings.get(name)
            if reading is not None:
                topics.publish(reading.value, time_of(reading.stamp))
