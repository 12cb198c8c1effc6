"""Poses of the robot over time: the contract, which tf meets over ROS, and a history without ROS."""

import math
from collections import deque
from typing import Deque, Dict, Optional, Protocol, Sequence, Tuple

import numpy as np

from planar import Pose2

# Number of odometry poses that are kept: 10 s, as in tf, at 50 Hz.
HISTORY_LENGTH = 500


class RobotPoses(Protocol):
    """Poses between the frames of map, odometry and base."""

    def base_in_odom(self, stamp: Optional[float] = None) -> Optional[Pose2]:
        """Return the pose of the base in the odometry frame.

        Args:
            stamp: Time of the pose [s]; None for the latest.

        Returns:
            The pose; None if it is not known at that time.
        """

    def base_in_space(self, stamp: float) -> Optional[np.ndarray]:
        """Return the pose of the base in the odometry frame with height, roll and pitch.

        Args:
            stamp: Time of the pose [s].

        Returns:
            Matrix (4, 4); None if it is not known at that time.
        """

    def frame_in_base(self, frame: str, stamp: float) -> Optional[np.ndarray]:
        """Return the pose of any frame, such as that of a sensor, in the base frame.

        Args:
            frame: Name of the frame.
            stamp: Time of the pose [s].

        Returns:
            Matrix (4, 4); None if it is not known at that time.
        """

    def missing_transform(self, frames: Sequence[str], stamp: float) -> str:
        """Describe the first transform between the frames, base and odometry that is unknown at a stamp.

        Args:
            frames: Names of frames.
            stamp: Time [s].
        """

    def odom_in_map(self) -> Optional[Pose2]:
        """Return the latest pose of the odometry frame in the map; None if it is unknown."""

    def odometry_stamp(self) -> Optional[float]:
        """Return the latest time at which odometry is known [s]: infinity if always, None if never."""

    def localization_stamp(self) -> Optional[float]:
        """Return the latest time for which localization is valid [s]: infinity if always, None if never."""

    def reset(self) -> None:
        """Discard all poses, as after a jump of time."""


class PoseHistory:
    """Poses from odometry and localization in the same process."""

    def __init__(self) -> None:
        self._mountings: Dict[str, np.ndarray] = {}
        self.reset()

    def reset(self) -> None:
        self._odometry: Deque[Tuple[float, Pose2]] = deque(maxlen=HISTORY_LENGTH)
        self._odom_in_map: Optional[Pose2] = None
        self._valid_until: Optional[float] = None

    def add_odometry(self, stamp: float, base_in_odom: Pose2) -> None:
        """Add a pose from odometry.

        Args:
            stamp: Time of the pose [s], later than those before.
            base_in_odom: Pose of the base in the odometry frame.
        """
        self._odometry.append((stamp, base_in_odom))

    def set_mounting(self, frame: str, frame_in_base: np.ndarray) -> None:
        """Set the pose of a sensor.

        Args:
            frame: Name of the sensor's frame.
            frame_in_base: Pose of the frame in the base frame (4, 4).
        """
        self._mountings[frame] = frame_in_base

    def set_odom_in_map(self, odom_in_map: Optional[Pose2], valid_until: float = math.inf) -> None:
        """Set the estimate of localization.

        Args:
            odom_in_map: Pose of the odometry frame in the map; None if it is unknown.
            valid_until: Time until which it is valid [s], as the post-dated transform of amcl.
        """
        self._odom_in_map = odom_in_map
        self._valid_until = None if odom_in_map is None else valid_until

    def base_in_odom(self, stamp: Optional[float] = None) -> Optional[Pose2]:
        """Return the odometry pose that is closest to a stamp; None for the latest stamp."""
        if not self._odometry:
            return None
        nearest, base_in_odom = math.inf, self._odometry[-1][1]
        if stamp is None:
            return base_in_odom
        for stamp_of, known in reversed(self._odometry):
            if abs(stamp_of - stamp) >= nearest:
                break  # stamps increase, so all earlier ones are farther away
            nearest, base_in_odom = abs(stamp_of - stamp), known
        return base_in_odom

    def base_in_space(self, stamp: float) -> Optional[np.ndarray]:
        base_in_odom = self.base_in_odom(stamp)
        return None if base_in_odom is None else base_in_odom.as_matrix()

    def frame_in_base(self, frame: str, stamp: float) -> Optional[np.ndarray]:
        return self._mountings.get(frame)

    def missing_transform(self, frames: Sequence[str], stamp: float) -> str:
        unknown = [frame for frame in frames if frame not in self._mountings]
        return f"no mounting of {unknown[0]}" if unknown else "no odometry"

    def odom_in_map(self) -> Optional[Pose2]:
        return self._odom_in_map

    def odometry_stamp(self) -> Optional[float]:
        return self._odometry[-1][0] if self._odometry else None

    def localization_stamp(self) -> Optional[float]:
        return self._valid_until
