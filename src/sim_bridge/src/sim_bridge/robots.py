"""The robots that can be simulated, as data."""

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Tuple

import numpy as np

from planar.settings import nearest_name
from sim_bridge.errors import RobotError
from sim_bridge.urdf_reader import frame_in_base

_URDF_FOLDER = Path(__file__).parent / "urdf"


@dataclass(frozen=True)
class LaserProfile:
    """A planar range finder.

    A beam that meets nothing within ``sight`` metres reads ``no_return``, one that meets something nearer
    than ``range_min`` reads ``too_near`` (REP 117).
    """

    frame: str
    beams: int
    angle_min: float
    angle_increment: float
    range_min: float
    range_max: float
    sight: float
    no_return: float
    too_near: float


@dataclass(frozen=True)
class DriveProfile:
    """A differential drive: ``wheel_separation`` and ``wheel_radius`` in metres, limits in SI units."""

    left_joint: str = "wheel_left_joint"
    right_joint: str = "wheel_right_joint"
    wheel_radius: float = 0.035
    wheel_separation: float = 0.230
    max_speed: float = 0.7
    max_turn_rate: float = math.pi
    max_acceleration: float = 2.0
    max_turn_acceleration: float = 6.0


@dataclass(frozen=True)
class RobotProfile:
    """A robot: the URDF files it is put together from, its drive and its laser."""

    name: str
    urdf_files: Tuple[str, ...]
    drive: DriveProfile
    laser: LaserProfile
    radius: float
    base_frame: str = "base_footprint"

    def description(self) -> str:
        """The robot's URDF: the first file with the parts of the others added."""
        first, *others = (ElementTree.parse(str(_URDF_FOLDER / file)).getroot() for file in self.urdf_files)
        for other in others:
            first.extend(other)
        first.set("name", self.name)
        return ElementTree.tostring(first, encoding="unicode")

    def mounting(self, frame: str) -> np.ndarray:
        """Where a frame is fixed on the robot, (4, 4) in ``base_frame``. Raises RobotError."""
        return frame_in_base(self.description(), self.base_frame, frame)


_LIDAR = LaserProfile(
    frame="laser",
    beams=360,
    angle_min=-math.pi,
    angle_increment=2.0 * math.pi / 360,
    range_min=0.12,
    range_max=10.0,
    sight=10.0,
    no_return=math.inf,
    too_near=-math.inf,
)

# As depthimage_to_laserscan makes it of the simulated Kinect: the depth image ends at 5 m.
_KINECT = LaserProfile(
    frame="camera_depth_frame",
    beams=640,
    angle_min=-math.radians(60.0) / 2.0,
    angle_increment=math.radians(60.0) / 639,
    range_min=0.45,
    range_max=10.0,
    sight=5.0,
    no_return=math.nan,
    too_near=math.nan,
)

# LDS-01 as turtlebot3_gazebo has it.
_LDS = LaserProfile(
    frame="base_scan",
    beams=360,
    angle_min=0.0,
    angle_increment=2.0 * math.pi / 359,
    range_min=0.12,
    range_max=3.5,
    sight=3.5,
    no_return=math.inf,
    too_near=-math.inf,
)

# Hokuyo UST-10LX in front, as BARN's Jackal has it.
_HOKUYO = LaserProfile(
    frame="front_laser",
    beams=720,
    angle_min=-math.radians(270.0) / 2.0,
    angle_increment=math.radians(270.0) / 719,
    range_min=0.1,
    range_max=30.0,
    sight=30.0,
    no_return=math.inf,
    too_near=-math.inf,
)

_JACKAL_DRIVE = DriveProfile(
    wheel_radius=0.049,
    wheel_separation=0.22,
    max_speed=2.0,
    max_turn_rate=4.0,
    max_acceleration=4.0,
    max_turn_acceleration=12.0,
)

_BURGER_DRIVE = DriveProfile(
    wheel_radius=0.033,
    wheel_separation=0.160,
    max_speed=0.22,
    max_turn_rate=2.84,
    max_acceleration=2.5,
    max_turn_acceleration=3.2,
)
_WAFFLE_DRIVE = DriveProfile(
    wheel_radius=0.033,
    wheel_separation=0.288,
    max_speed=0.26,
    max_turn_rate=1.82,
    max_acceleration=2.5,
    max_turn_acceleration=3.2,
)

ROBOTS: Dict[str, RobotProfile] = {
    profile.name: profile
    for profile in (
        RobotProfile("turtlebot_lidar", ("turtlebot2.urdf", "lidar.urdf"), DriveProfile(), _LIDAR, 0.178),
        RobotProfile("turtlebot_kinect", ("turtlebot2.urdf", "kinect.urdf"), DriveProfile(), _KINECT, 0.178),
        RobotProfile("turtlebot3_burger", ("turtlebot3_burger.urdf",), _BURGER_DRIVE, _LDS, 0.105),
        RobotProfile("turtlebot3_waffle", ("turtlebot3_waffle.urdf",), _WAFFLE_DRIVE, _LDS, 0.220),
        RobotProfile("jackal", ("jackal.urdf",), _JACKAL_DRIVE, _HOKUYO, 0.267),
    )
}


def robot_named(name: str) -> RobotProfile:
    """The profile of that name. Raises RobotError."""
    if name not in ROBOTS:
        nearest = nearest_name(name, ROBOTS)
        hint = f", did you mean {nearest}?" if nearest else ""
        raise RobotError(f"unknown robot {name!r}{hint} (known: {', '.join(ROBOTS)})")
    return ROBOTS[name]
