"""Publication of estimates: topics, transform, and the checkpoint for a restart."""

from typing import Optional

import rospy

from amcl_lite.localizer import Estimate, Localizer
from amcl_lite.ros.locked_localizer import LockedLocalizer
from amcl_lite.ros.pose_checkpoint import PoseCheckpoint
from amcl_lite.ros.tf_bridge import TfBridge
from amcl_lite.ros.topics import AmclTopics
from planar import Pose2


class EstimatePublisher:
    """Publishes the result of each scan; ``last_estimate`` has the stamp ``last_stamp``."""

    def __init__(self, shared: LockedLocalizer, views: AmclTopics, tf_bridge: TfBridge):
        self.last_estimate: Optional[Estimate] = None
        self.last_stamp = rospy.Time(0)
        self._shared, self._views, self._tf_bridge = shared, views, tf_bridge
        self._checkpoint = PoseCheckpoint()
        self._saved_belief = self._checkpoint.load_belief()
        self._base_in_odom: Optional[Pose2] = None

    def restore_checkpoint(self, localizer: Localizer) -> None:
        """Resume from the belief of a crashed node, before the first scan."""
        before, self._saved_belief = self._saved_belief, None
        if before is not None:
            localizer.restore(before)

    def publish(
        self,
        localizer: Localizer,
        estimate: Optional[Estimate],
        is_updated: bool,
        base_in_odom: Pose2,
        stamp: rospy.Time,
    ) -> None:
        """Publish the result of a scan.

        Args:
            localizer: The Localizer.
            estimate: The new estimate, if any.
            is_updated: Whether the scan was used for an update.
            base_in_odom: Odometry pose of the scan.
            stamp: Stamp of the scan.
        """
        self._base_in_odom = base_in_odom
        if is_updated:
            self._views.publish_particles(localizer)
        if estimate is not None:
            self.last_estimate, self.last_stamp = estimate, stamp
            self._views.publish_estimate(estimate, stamp)
        if localizer.odom_in_map is None or self.last_estimate is None:
            return
        self._tf_bridge.send(localizer.odom_in_map, stamp)
        self._views.publish_quality(localizer)
        self._views.publish_diagnostics(localizer, self.last_estimate)
        belief = localizer.belief if estimate is None else None
        if belief is not None:
            rate, covariance = self._shared.settings.save_pose_rate, self.last_estimate.covariance
            self._checkpoint.save_if_due(rate, belief, base_in_odom, covariance)

    def save_pose(self) -> None:
        """Save the pose at shutdown, for the next start."""
        with self._shared.lock:
            localizer = self._shared.localizer
            odom_in_map = None if localizer is None else localizer.odom_in_map
            base_in_odom, estimate = self._base_in_odom, self.last_estimate
            if odom_in_map is not None and base_in_odom is not None and estimate is not None:
                self._checkpoint.save(odom_in_map @ base_in_odom, estimate.covariance)
