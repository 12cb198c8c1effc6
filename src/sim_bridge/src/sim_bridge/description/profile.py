"""What a robot is made of and can do, as data."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Optional, Tuple, Type, TypeVar

from sim_bridge.description.structure import RobotModel
from sim_bridge.driving.drive import DriveProfile
from sim_bridge.sensors.base import SensorSpec
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.sensors.odometry import OdometryProfile

Spec = TypeVar("Spec")


@dataclass(frozen=True)
class JointStateProfile:
    """Joints that are told; ``rate`` in hertz, None for the simulation's."""

    joints: Tuple[str, ...]
    rate: Optional[float] = None
    topic: str = "joint_states"


@dataclass(frozen=True, eq=False)
class RobotProfile:
    """A robot: its parts, its drive and its sensors.

    ``namespace``: that its description asks for. ``warnings``: what the description holds that is left out.
    """

    name: str
    text: str
    model: RobotModel
    drive: DriveProfile
    odometry: OdometryProfile = OdometryProfile()
    sensors: Tuple[SensorSpec, ...] = ()
    joint_states: Optional[JointStateProfile] = None
    namespace: str = ""
    warnings: Tuple[str, ...] = field(default=())

    def description(self) -> str:
        """The text, URDF or SDF, that the robot was read from."""
        return self.text

    def sensors_of(self, kind: Type[Spec]) -> Tuple[Spec, ...]:
        """Those of the sensors whose specs are of a class."""
        return tuple(sensor for sensor in self.sensors if isinstance(sensor, kind))

    @cached_property
    def scanner(self) -> str:
        """The name that the first range finder tells its scans by; empty if there is none."""
        return next((laser.topic for laser in self.sensors_of(LaserProfile)), "")

    @property
    def laser(self) -> LaserProfile:
        """The first range finder."""
        return self.sensors_of(LaserProfile)[0]

    @property
    def radius(self) -> float:
        """Of the circle about the base's origin that holds the robot, metres."""
        return self.model.radius
