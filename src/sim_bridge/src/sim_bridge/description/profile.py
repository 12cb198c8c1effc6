"""What a robot is made of and can do, as data."""

import math
from dataclasses import dataclass, field
from typing import Optional, Tuple

import numpy as np

from sim_bridge.description.structure import RobotModel
from sim_bridge.sensors.camera import CameraSettings


@dataclass(frozen=True, eq=False)
class LaserProfile:
    """A planar range finder, fixed at ``pose_in_base`` (4, 4); its readings are told in ``frame``.

    A beam that meets nothing within ``sight`` metres reads ``no_return``, one that meets something nearer
    than ``range_min`` reads ``too_near`` (REP 117). ``rate`` in hertz and ``noise``, the standard deviation
    of a range in metres, are None where the simulation's settings decide. ``scan_time``, s, is only told.
    """

    frame: str
    topic: str
    pose_in_base: np.ndarray
    beams: int
    angle_min: float
    angle_increment: float
    range_min: float
    range_max: float
    sight: float
    no_return: float = math.inf
    too_near: float = -math.inf
    scan_time: float = 0.0
    rate: Optional[float] = None
    noise: Optional[float] = None


@dataclass(frozen=True)
class DriveProfile:
    """Driven wheels on both sides: radius and separation in metres, torque in N m, limits in SI units.

    The robot stops when no command has come for ``command_timeout`` seconds.
    """

    left_joints: Tuple[str, ...]
    right_joints: Tuple[str, ...]
    wheel_radius: float
    wheel_separation: float
    torque: float
    command_topics: Tuple[str, ...] = ("cmd_vel",)
    max_speed: float = math.inf
    max_turn_rate: float = math.inf
    max_acceleration: float = math.inf
    max_turn_acceleration: float = math.inf
    command_timeout: float = math.inf

    @property
    def joints(self) -> Tuple[str, ...]:
        """Of all driven wheels, those on the left first."""
        return self.left_joints + self.right_joints


# x, y and yaw are measured, the rest is not (kobuki_gazebo_plugins).
KOBUKI_VARIANCES = (0.1, 0.1, 1e6, 1e6, 1e6, 0.05)


@dataclass(frozen=True)
class OdometryProfile:
    """How a robot measures where it is.

    ``source``: ``gyro`` (distance from the wheels, heading from a gyro), ``encoder`` (both from the wheels)
    or ``world`` (the truth, in the frame of the world). ``rate`` in hertz, None for the simulation's.
    ``variances``, which are only told: of x, y, z, m^2, roll, pitch and yaw, rad^2.
    """

    source: str = "encoder"
    topic: str = "odom"
    frame: str = "odom"
    base_frame: str = "base_footprint"
    sends_transform: bool = True
    rate: Optional[float] = None
    variances: Tuple[float, ...] = KOBUKI_VARIANCES


@dataclass(frozen=True)
class JointStateProfile:
    """Joints that are told; ``rate`` in hertz, None for the simulation's."""

    joints: Tuple[str, ...]
    rate: Optional[float] = None
    topic: str = "joint_states"


@dataclass(frozen=True, eq=False)
class CameraProfile:
    """A camera that looks along x of ``pose_in_base`` (4, 4), ``rate`` times a second.

    ``frame`` is the optical one. Topics of the colour picture and, if it measures depth, of the depth picture
    and the points; a topic that is empty is not there.
    """

    frame: str
    pose_in_base: np.ndarray
    settings: CameraSettings
    rate: float
    image_topic: str
    info_topic: str
    depth_topic: str = ""
    depth_info_topic: str = ""
    points_topic: str = ""


@dataclass(frozen=True, eq=False)
class ImuProfile:
    """An inertial sensor at ``pose_in_base`` (4, 4).

    ``rate`` in hertz and ``noise``, the standard deviation of what it measures in SI units, are None where
    the simulation's settings decide. Variances, (3,) each, about and along its axes, are only told; 0 means
    unknown (sensor_msgs/Imu).
    """

    topic: str
    frame: str
    pose_in_base: np.ndarray
    rate: Optional[float] = None
    noise: Optional[float] = None
    orientation_variances: Tuple[float, ...] = (0.0, 0.0, 0.0)
    turn_variances: Tuple[float, ...] = (0.0, 0.0, 0.0)
    acceleration_variances: Tuple[float, ...] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class KobukiProfile:
    """What a Kobuki base has besides its drive. ``cliff_threshold``: of the range to the floor, metres."""

    cliff_threshold: float = 0.04


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
    lasers: Tuple[LaserProfile, ...] = ()
    cameras: Tuple[CameraProfile, ...] = ()
    imus: Tuple[ImuProfile, ...] = ()
    joint_states: Optional[JointStateProfile] = None
    kobuki: Optional[KobukiProfile] = None
    namespace: str = ""
    warnings: Tuple[str, ...] = field(default=())

    def description(self) -> str:
        """The text, URDF or SDF, that the robot was read from."""
        return self.text

    @property
    def laser(self) -> LaserProfile:
        """The first range finder."""
        return self.lasers[0]

    @property
    def radius(self) -> float:
        """Of the circle about the base's origin that holds the robot, metres."""
        return self.model.radius
