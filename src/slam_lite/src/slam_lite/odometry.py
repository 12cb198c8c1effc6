"""What odometry is worth: its errors as the settings say, and as they turn out where scans tell the motion.

Its constant part - so much turn too much per metre and per radian, so much way per metre - is learned by
least squares and taken off, what is left by its mean square (after A. Censi et al., "Simultaneous calibration
of odometry and sensor parameters for mobile robots", IEEE T-RO 2013). So the robot keeps its heading where
there is little to see.
"""

import math

import numpy as np

from planar import Pose2, wrap
from slam_lite.config import MapperSettings

# How far odometry goes, metres and radians, until it errs in another way, and its error at rest.
_LEG_WAY, _LEG_TURN, _FLOOR = 0.3, 0.3, 0.005
# What constant errors are like before anything is known of them: rad/m, rad/rad, m/m.
_PRIOR = np.array([0.01, 0.05, 0.05])
# The random rest of the error has at least this share of the variance in the settings, and at most all of it;
# these count as so many motions.
_LEAST_SHARE, _OPINION = 0.02, 50.0
# Errors of more than so many standard deviations are slips, of which nothing is learned.
_SLIP = 5.0


class Odometry:
    """Motions as odometry tells them, mended, and how far they may be off."""

    def __init__(self, settings: MapperSettings):
        self._settings = settings
        # Normal equations of the constants: of heading by way and turn, and of the way.
        self._yaw_information, self._way_information = np.diag(_PRIOR[:2] ** -2), _PRIOR[2] ** -2
        self._yaw_sum, self._way_sum = np.zeros(2), 0.0
        # Sums of the squared rest in units of the settings' variance, (2,): way, heading; and how many.
        self._squares, self._count = np.full(2, _OPINION), _OPINION

    def mended(self, motion: Pose2) -> Pose2:
        """A motion without its constant error."""
        per_way, per_turn = np.linalg.solve(self._yaw_information, self._yaw_sum)
        way = motion.x * (1.0 + self._way_sum / self._way_information)
        return Pose2(way, motion.y, motion.yaw + per_way * motion.x + per_turn * motion.yaw)

    def variance(self, motion: Pose2) -> np.ndarray:
        """Variances (3,), m^2, m^2, rad^2, of what is left of the error of a motion."""
        xy, yaw = np.clip(self._squares / self._count, _LEAST_SHARE, 1.0)
        floor = _FLOOR**2
        return (self.believed_variance(motion) - floor) * [xy, xy, yaw] + floor

    def believed_variance(self, motion: Pose2) -> np.ndarray:
        """Variances (3,) by the settings: in proportion on one leg, at random between them."""
        settings = self._settings
        distance, turn = math.hypot(motion.x, motion.y), abs(motion.yaw)
        way, turning = distance * max(distance, _LEG_WAY), turn * max(turn, _LEG_TURN)
        xy = settings.odom_xy_per_distance**2 * way + settings.odom_xy_per_turn**2 * turning
        yaw = settings.odom_yaw_per_distance**2 * way + settings.odom_yaw_per_turn**2 * turning
        return np.array([xy, xy, yaw]) + _FLOOR**2

    def learn(self, motion: Pose2, matched: Pose2) -> None:
        """Takes in what the scans made of a ``motion``: they are sure of it."""
        rest = (self.mended(motion).inverse() @ matched).as_array()
        variance, believed = self.variance(motion), self.believed_variance(motion)
        if (rest**2 > _SLIP**2 * believed).any():
            return
        by = np.array([motion.x, motion.yaw])
        self._yaw_information += np.outer(by, by) / variance[2]
        self._yaw_sum += by * wrap(matched.yaw - motion.yaw) / variance[2]
        self._way_information += motion.x**2 / variance[0]
        self._way_sum += motion.x * (matched.x - motion.x) / variance[0]
        self._squares += rest[[0, 2]] ** 2 / believed[[0, 2]]
        self._count += 1.0
