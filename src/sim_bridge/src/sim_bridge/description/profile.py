"""Robot profiles: parts, drive and sensors."""

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from functools import cached_property
from typing import Optional, Set, Tuple, Type, TypeVar

from sim_bridge.description.structure import RobotModel
from sim_bridge.driving.drive import DriveProfile
from sim_bridge.power.battery import BatteryProfile
from sim_bridge.sensors.base import SensorSpec
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.sensors.odometry import OdometryProfile

Spec = TypeVar("Spec")


@dataclass(frozen=True)
class JointStateProfile:
    """Joints whose states are published (sensor_msgs/JointState).

    Attributes:
        joints: Names of the joints.
        rate: Rate of the messages [Hz]; None for that of the simulation.
        topic: Topic of the messages.
    """

    joints: Tuple[str, ...]
    rate: Optional[float] = None
    topic: str = "joint_states"


@dataclass(frozen=True, eq=False)
class RobotProfile:
    """A robot: its rigid parts, drive, odometry and sensors.

    Attributes:
        name: Name in its description.
        text: The URDF or SDF text that it was read from.
        model: Base and driven wheels.
        drive: Wheels, command topics and limits.
        odometry: Source, topic and frames of its odometry.
        sensors: Specifications of its sensors.
        joint_states: Published joints, if any.
        battery: Its battery; None for a robot that never needs to be charged.
        namespace: Namespace of its topics, as its description requests.
        warnings: A sentence for each kind of content of the description that is ignored.
    """

    name: str
    text: str
    model: RobotModel
    drive: DriveProfile
    odometry: OdometryProfile = OdometryProfile()
    sensors: Tuple[SensorSpec, ...] = ()
    joint_states: Optional[JointStateProfile] = None
    namespace: str = ""
    battery: Optional[BatteryProfile] = None
    warnings: Tuple[str, ...] = field(default=())

    def description(self) -> str:
        """Return the URDF or SDF text that the robot was read from."""
        return self.text

    def frames_below(self, frame: str) -> Set[str]:
        """Return a frame and all links of the URDF below it, which robot_state_publisher connects to it."""
        joints = ElementTree.fromstring(self.text).findall("joint")
        ends = [{end.tag: end.get("link", "") for end in joint} for joint in joints]
        frames, more = {frame}, {frame}
        while more:
            more = {end["child"] for end in ends if end.get("parent") in more and "child" in end} - frames
            frames |= more
        return frames

    def sensors_of(self, kind: Type[Spec]) -> Tuple[Spec, ...]:
        """Return the sensor specifications of a class, such as LaserProfile."""
        return tuple(sensor for sensor in self.sensors if isinstance(sensor, kind))

    @cached_property
    def scanner(self) -> str:
        """Sensor name of the first range finder; empty if there is none."""
        return next((laser.topic for laser in self.sensors_of(LaserProfile)), "")

    @property
    def laser(self) -> LaserProfile:
        """Specification of the first range finder.

        Raises:
            IndexError: The robot has no range finder.
        """
        return self.sensors_of(LaserProfile)[0]

    @property
    def radius(self) -> float:
        """Radius of the circle around the base's origin that contains the robot [m]."""
        return self.model.radius
