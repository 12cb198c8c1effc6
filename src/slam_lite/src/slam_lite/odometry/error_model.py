"""Error model of odometry: variance from the settings, and bias estimated from scan matching.

The bias (heading per metre and per radian, distance per metre) is estimated by least squares and removed; the
remaining random error is estimated by its mean square (after A. Censi et al., "Simultaneous calibration of
odometry and sensor parameters for mobile robots", IEEE T-RO 2013). So the robot keeps its heading where there
is little to match.
"""

import math

import numpy as np

from planar import Pose2, wrap
from slam_lite.config import MapperSettings

# Motion, metres and radians, over which errors of odometry are correlated, and its error at rest.
_LEG_DISTANCE, _LEG_TURN, _FLOOR = 0.3, 0.3, 0.005
# Standard deviations of the bias before anything is learned: rad/m, rad/rad, m/m.
_PRIOR = np.array([0.01, 0.05, 0.05])
# Least random error as a share of the variance in the settings (the largest is 1), and number of motions that
# this prior counts as.
_MIN_SHARE, _PRIOR_COUNT = 0.02, 50.0
# Standard deviations above which an error is a wheel slip, which is excluded from the estimates.
_SLIP_SIGMAS = 5.0


class OdometryErrorModel:
    """Estimates and removes the bias of odometry, and computes the variance of the remaining error."""

    def __init__(self, settings: MapperSettings):
        """Create the model without bias.

        Args:
            settings: Errors of odometry: ``odom_xy_per_distance``, ``odom_yaw_per_distance``,
                ``odom_xy_per_turn`` and ``odom_yaw_per_turn``.
        """
        self._settings = settings
        # Normal equations of the bias: of heading by distance and turn, and of distance.
        self._yaw_information, self._distance_information = np.diag(_PRIOR[:2] ** -2), _PRIOR[2] ** -2
        self._yaw_sum, self._distance_sum = np.zeros(2), 0.0
        self._yaw_bias = np.zeros(2)
        # Sums (2,) of the squared random error, distance and heading, in units of the settings' variance.
        self._squares, self._count = np.full(2, _PRIOR_COUNT), _PRIOR_COUNT

    def corrected(self, motion: Pose2) -> Pose2:
        """Remove the estimated bias from a motion.

        Args:
            motion: Pose of the base relative to the last scan, from odometry.
        """
        per_distance, per_turn = self._yaw_bias
        x = motion.x * (1.0 + self._distance_sum / self._distance_information)
        return Pose2(x, motion.y, motion.yaw + per_distance * motion.x + per_turn * motion.yaw)

    def variance(self, motion: Pose2) -> np.ndarray:
        """Compute the variances (3,) of a corrected motion [m^2, m^2, rad^2]."""
        return self._learned_variance(self.nominal_variance(motion))

    def _learned_variance(self, nominal: np.ndarray) -> np.ndarray:
        xy, yaw = np.minimum(np.maximum(self._squares / self._count, _MIN_SHARE), 1.0)
        floor = _FLOOR**2
        return (nominal - floor) * [xy, xy, yaw] + floor

    def nominal_variance(self, motion: Pose2) -> np.ndarray:
        """Compute the variances (3,) of a motion according to the settings [m^2, m^2, rad^2].

        Errors are correlated within a leg of the trajectory, and independent beyond.
        """
        settings = self._settings
        distance, turn = math.hypot(motion.x, motion.y), abs(motion.yaw)
        by_distance, by_turn = distance * max(distance, _LEG_DISTANCE), turn * max(turn, _LEG_TURN)
        xy = settings.odom_xy_per_distance**2 * by_distance + settings.odom_xy_per_turn**2 * by_turn
        yaw = settings.odom_yaw_per_distance**2 * by_distance + settings.odom_yaw_per_turn**2 * by_turn
        return np.array([xy, xy, yaw]) + _FLOOR**2

    def learn(self, motion: Pose2, matched: Pose2) -> None:
        """Update the estimates of bias and random error.

        Args:
            motion: Pose of the base relative to the last scan, from odometry.
            matched: The same pose from a reliable scan match.
        """
        residual = (self.corrected(motion).inverse() @ matched).as_array()
        nominal = self.nominal_variance(motion)
        if (residual**2 > _SLIP_SIGMAS**2 * nominal).any():
            return
        variance = self._learned_variance(nominal)
        regressors = np.array([motion.x, motion.yaw])
        self._yaw_information += np.outer(regressors, regressors) / variance[2]
        self._yaw_sum += regressors * wrap(matched.yaw - motion.yaw) / variance[2]
        self._yaw_bias = np.linalg.solve(self._yaw_information, self._yaw_sum)
        self._distance_information += motion.x**2 / variance[0]
        self._distance_sum += motion.x * (matched.x - motion.x) / variance[0]
        self._squares += residual[[0, 2]] ** 2 / nominal[[0, 2]]
        self._count += 1.0
