"""Control laws of docking, and free space in a scan."""

import math
from typing import Optional

import numpy as np

from auto_docking_lite.config import DockingSettings
from planar import Pose2, Scan, Twist2, wrap

# Heading error from which the robot turns on the spot, and to which it then turns [rad].
TURN_ERROR = 0.6
# Lookahead on the middle line [m] and gains [1/s].
LOOKAHEAD, TURN_GAIN, SPEED_GAIN, CONTACT_GAIN = 0.25, 2.0, 0.9, 0.35
# Clearance beyond the robot's radius [m], and by how much an obstacle may come closer than it is [m].
CLEARANCE, TOUCH = 0.04, 0.02


def turn_to(error: float, settings: DockingSettings) -> Twist2:
    """Return the command that turns by a heading error [rad]."""
    return Twist2(0.0, max(-settings.turn_rate, min(settings.turn_rate, TURN_GAIN * error)))


def drive_to(base: Pose2, target: Pose2, settings: DockingSettings) -> Twist2:
    """Return the command that drives to a position; the robot turns on the spot if it is not ahead.

    Args:
        base: Pose of the robot.
        target: Its target, in the same frame.
        settings: Speeds.
    """
    error = wrap(math.atan2(target.y - base.y, target.x - base.x) - base.yaw)
    if abs(error) > TURN_ERROR:
        return turn_to(error, settings)
    distance = base.distance_to(target)
    speed = min(settings.max_speed, SPEED_GAIN * distance + 0.03) * math.cos(error)
    return Twist2(speed, turn_to(error, settings).omega)


def follow_line(base_in_dock: Pose2, front_distance: float, settings: DockingSettings) -> Twist2:
    """Return the command that drives to a dock along its middle line by turning to a point ahead on it.

    Args:
        base_in_dock: Pose of the robot in the dock's frame.
        front_distance: Distance of the robot's front to the dock [m].
        settings: Speeds.
    """
    speed = min(max(CONTACT_GAIN * front_distance, settings.contact_speed), settings.approach_speed)
    error = wrap(math.atan2(-base_in_dock.y, -LOOKAHEAD) - base_in_dock.yaw)
    omega = turn_to(error, settings).omega
    return Twist2(speed * max(math.cos(error), 0.0), omega)


def obstacles_in_base(scan: Optional[Scan]) -> np.ndarray:
    """Return the obstacles (N, 2) of a scan in the base frame [m]; none without a scan."""
    return np.empty((0, 2)) if scan is None else scan.hit_points_in_base()


def is_free(obstacles_xy: np.ndarray, start: Pose2, end: Pose2, radius: float) -> bool:
    """Return whether a robot can drive straight between two positions.

    An obstacle that is already near does not hinder a robot that comes no closer to it.

    Args:
        obstacles_xy: Obstacles (N, 2), in the frame of the poses.
        start: Start of the drive.
        end: End of the drive.
        radius: Radius of the robot [m].
    """
    if len(obstacles_xy) == 0:
        return True
    from_start = obstacles_xy - (start.x, start.y)
    along = np.array((end.x - start.x, end.y - start.y))
    length = float(along @ along)
    share = np.clip(from_start @ along / length, 0.0, 1.0) if length > 0.0 else np.zeros(len(from_start))
    distances = np.hypot(*(from_start - share[:, None] * along).T)
    needed = np.minimum(radius + CLEARANCE, np.hypot(*from_start.T) - TOUCH)
    return bool((distances >= needed).all())
