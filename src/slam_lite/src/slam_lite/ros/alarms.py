"""What is wrong with the scans or the odometry, told now and then."""

from typing import Dict

import rospy

from planar_ros.messages.conversion import frame_name
from planar_ros.messages.transforms import Transforms

ALARM_SECONDS = 15.0
# A surprise of 3 is normal; odometry that errs several times more than it should is worth a warning.
MEAN_SURPRISE_ALARM = 30.0
SURPRISE_MEMORY = 100
# How far the z axis of a laser may be from straight up or down: gmapping's bound for its height.
PLANAR_TOLERANCE = 1e-3


class MountingAlarm:
    """Tells lasers that are not mounted planar."""

    def __init__(self, transforms: Transforms, base_frame: str):
        self._transforms = transforms
        self._base_frame = base_frame
        self._heights: Dict[str, float] = {}

    def is_planar(self, laser_frame: str) -> bool:
        """Whether the laser's axis points straight up or down; a warning if not."""
        if laser_frame not in self._heights:
            mounting = self._transforms.matrix(self._base_frame, laser_frame)
            self._heights[laser_frame] = 1.0 if mounting is None else float(mounting[2, 2])
        height = self._heights[laser_frame]
        if abs(abs(height) - 1.0) <= PLANAR_TOLERANCE:
            return True
        rospy.logwarn_throttle(
            ALARM_SECONDS,
            "laser %s has to be mounted planar: the z coordinate of its axis has to be 1 or -1, not %.5f",
            frame_name(laser_frame),
            height,
        )
        return False


class OdometryAlarm:
    """Tells odometry that errs more than its settings say."""

    def __init__(self) -> None:
        self._surprise = 0.0

    def note(self, surprise: float) -> None:
        """Takes in the surprise of one scan (see PoseUpdate)."""
        self._surprise += (min(surprise, 1e3) - self._surprise) / SURPRISE_MEMORY
        if self._surprise > MEAN_SURPRISE_ALARM:
            rospy.logwarn_throttle(
                ALARM_SECONDS,
                "odometry disagrees with the scans (%.0f times the variance promised by srr, srt, str, stt); "
                "the map may suffer where there is little to see",
                self._surprise / 3.0,
            )
