"""Broadcaster of the transform map -> odom."""

from typing import Optional

import rospy

from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import frame_name
from planar_ros.messages.transforms import Transforms
from slam_lite.config import NodeSettings
from slam_lite.ros.thread_safe_mapper import ThreadSafeMapper


class MapTransformBroadcaster:
    """Broadcasts map -> odom every ``transform_publish_period``, unless that is 0."""

    def __init__(self, settings: NodeSettings, mapper: ThreadSafeMapper, transforms: Transforms):
        """Start broadcasting.

        Args:
            settings: Frames, ``transform_publish_period`` and ``tf_delay``.
            mapper: Source of the odometry frame in the map.
            transforms: Broadcasts the transform.
        """
        self._settings = settings
        self._mapper = mapper
        self._transforms = transforms
        self._stamp: Optional[rospy.Time] = None
        if settings.transform_publish_period > 0.0:
            self._send()
            LockstepClient.of_node().every(
                lambda: settings.transform_publish_period, lambda _now: self._send(), lambda: None
            )

    def _send(self) -> None:
        settings = self._settings
        delay = settings.tf_delay if settings.tf_delay >= 0.0 else settings.transform_publish_period
        stamp = rospy.Time.now() + rospy.Duration(delay)
        if stamp == self._stamp:
            return  # a simulated clock may stand still, and tf warns of repeated stamps
        self._stamp = stamp
        map_frame, odom_frame = frame_name(settings.map_frame), frame_name(settings.odom_frame)
        self._transforms.send(self._mapper.odom_in_map, map_frame, odom_frame, stamp)
