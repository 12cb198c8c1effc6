"""Checks of the node's input, which log throttled warnings."""

import rospy

from planar_ros.messages.conversion import frame_name
from planar_ros.messages.transforms import Transforms

WARNING_SECONDS = 15.0
# Mean chi-square of odometry from which on a warning is logged (3 is normal), and scans it is averaged over.
MAX_MEAN_CHI_SQUARE = 30.0
AVERAGED_SCANS = 100
# Tolerance of the z coordinate of a laser's axis, by gmapping.
PLANAR_TOLERANCE = 1e-3


class LaserMountingCheck:
    """Rejects lasers that are not mounted planar."""

    def __init__(self, transforms: Transforms, base_frame: str):
        """Create the check.

        Args:
            transforms: Source of the transform from base to laser.
            base_frame: Frame of the robot.
        """
        self._transforms = transforms
        self._base_frame = base_frame

    def is_planar(self, laser_frame: str, stamp: rospy.Time) -> bool:
        """Check whether the laser's axis points straight up or down; log a warning if not.

        Args:
            laser_frame: Frame of the scan.
            stamp: Stamp of the scan.
        """
        mounting = self._transforms.matrix(self._base_frame, laser_frame, stamp)
        height = 1.0 if mounting is None else float(mounting[2, 2])
        if abs(abs(height) - 1.0) <= PLANAR_TOLERANCE:
            return True
        rospy.logwarn_throttle(
            WARNING_SECONDS,
            "Laser has to be mounted planar! Z-coordinate has to be 1 or -1, but gave: %.5f (frame %s)",
            height,
            frame_name(laser_frame),
        )
        return False


class OdometryCheck:
    """Logs a warning if odometry has larger errors than its settings state."""

    def __init__(self) -> None:
        self._mean_chi_square = 0.0

    def update(self, chi_square: float) -> None:
        """Add one scan.

        Args:
            chi_square: ``PoseUpdate.odometry_chi_square`` of the scan.
        """
        self._mean_chi_square += (min(chi_square, 1e3) - self._mean_chi_square) / AVERAGED_SCANS
        if self._mean_chi_square > MAX_MEAN_CHI_SQUARE:
            rospy.logwarn_throttle(
                WARNING_SECONDS,
                "odometry disagrees with the scans (%.0f times the variance by srr, srt, str, stt): the map "
                "may be distorted where few walls are visible; check odometry, or raise these parameters",
                self._mean_chi_square / 3.0,
            )
