"""The topics of the node amcl."""

import numpy as np
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Point, PoseArray, PoseWithCovarianceStamped
from std_msgs.msg import ColorRGBA, Float32, String
from visualization_msgs.msg import Marker

from amcl_lite.localizer import Estimate, Localizer
from amcl_lite.recovery.quality import MapMismatchMonitor
from amcl_lite.ros.locked_localizer import LockedLocalizer
from planar import OccupancyGrid
from planar.geometry.pose import cos_sin
from planar_ros.messages.conversion import (
    OccupancyGridArrays,
    PosesMsg,
    frame_name,
    grid_to_msg,
    pose2_to_msg,
)

DIAGNOSTICS_PERIOD = 1.0
# Length of the lines for weighted particles [m], and their largest number.
MARKER_LENGTH, MARKER_COUNT = 0.1, 500
MAP_MISMATCH_TEXT = "the scans do not fit the map; check its resolution, its origin and the initial pose"


class AmclTopics:
    """Publishes the topics of amcl, and further ones below ``~`` while they have subscribers."""

    def __init__(self, shared: LockedLocalizer):
        self._shared = shared
        self._pose = rospy.Publisher("amcl_pose", PoseWithCovarianceStamped, queue_size=2, latch=True)
        self._cloud = rospy.Publisher("particlecloud", PoseArray, queue_size=2, latch=True)
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=2)
        self._quality = rospy.Publisher("~localization_quality", Float32, queue_size=2)
        self._state = rospy.Publisher("~localization_state", String, queue_size=2, latch=True)
        self._particles = rospy.Publisher("~weighted_particles", Marker, queue_size=1)
        self._field = rospy.Publisher("~likelihood_field", OccupancyGridArrays, queue_size=1, latch=True)
        self._shown_state = ""
        self._misfit = MapMismatchMonitor()
        self._diagnosed = rospy.Time(0)

    @property
    def _frame(self) -> str:
        return frame_name(self._shared.settings.map_frame)

    def publish_estimate(self, estimate: Estimate, stamp: rospy.Time) -> None:
        message = PoseWithCovarianceStamped()
        message.header.stamp, message.header.frame_id = stamp, self._frame
        message.pose.pose = pose2_to_msg(estimate.base_in_map)
        covariance = np.zeros((6, 6))
        covariance[:2, :2] = estimate.covariance[:2, :2]
        covariance[5, 5] = estimate.covariance[2, 2]
        message.pose.covariance = covariance.ravel().tolist()
        self._pose.publish(message)

    def publish_particles(self, localizer: Localizer) -> None:
        poses, weights = localizer.particles.poses, localizer.particles.weights
        self._cloud.publish(PosesMsg(poses, rospy.Time.now(), self._frame))
        if self._particles.get_num_connections() > 0:
            self._particles.publish(self._weighted_particles(poses, weights))

    def publish_likelihood_field(self, field_grid: OccupancyGrid) -> None:
        self._field.publish(grid_to_msg(field_grid, rospy.Time.now(), self._frame))

    def publish_quality(self, localizer: Localizer) -> None:
        """Publish the fit of the last scan and changes of the localization state."""
        if localizer.quality is None:
            return
        if self._quality.get_num_connections() > 0:
            self._quality.publish(localizer.quality.probability)
        if self._misfit.add(localizer.quality, rospy.get_time()):
            rospy.logwarn(MAP_MISMATCH_TEXT)
        state = "lost" if localizer.is_lost else "ok"
        if state != self._shown_state:
            self._shown_state = state
            self._state.publish(state)
            log = rospy.logwarn if localizer.is_lost else rospy.loginfo
            log("localization is %s (quality %.2f)", state, localizer.quality.probability)

    def publish_diagnostics(self, localizer: Localizer, estimate: Estimate) -> None:
        """Publish amcl's standard deviation status and the fit, once a second."""
        now = rospy.Time.now()
        if abs((now - self._diagnosed).to_sec()) < DIAGNOSTICS_PERIOD:
            return
        self._diagnosed = now
        message = DiagnosticArray(status=[self._spread(estimate), _fit(localizer)])
        message.header.stamp = now
        self._diagnostics.publish(message)

    def _spread(self, estimate):
        settings = self._shared.settings
        limits = (settings.std_warn_level_x, settings.std_warn_level_y, settings.std_warn_level_yaw)
        spreads = np.sqrt(np.maximum(np.diag(estimate.covariance), 0.0))
        values = {f"std_{name}": spread for name, spread in zip(("x", "y", "yaw"), spreads)}
        values.update({f"std_warn_level_{name}": limit for name, limit in zip(("x", "y", "yaw"), limits)})
        is_too_large = bool(np.any(spreads > limits))
        return _status("Standard deviation", is_too_large, "Too large" if is_too_large else "OK", values)

    def _weighted_particles(self, poses, weights):
        marker = Marker(type=Marker.LINE_LIST, action=Marker.ADD, ns="weighted_particles")
        marker.header.stamp, marker.header.frame_id = rospy.Time.now(), self._frame
        marker.pose.orientation.w = 1.0
        marker.scale.x = 0.1 * MARKER_LENGTH
        heaviest = np.argsort(-weights, kind="stable")[:MARKER_COUNT]
        tips = poses[:, :2] + MARKER_LENGTH * np.column_stack(cos_sin(poses[:, 2]))
        for i in heaviest:
            share = weights[i] / weights[heaviest[0]]
            marker.points += [Point(*poses[i, :2], 0.0), Point(*tips[i], 0.0)]
            marker.colors += [ColorRGBA(share, 0.0, 1.0 - share, 1.0)] * 2
        return marker


def _fit(localizer):
    quality, particles = localizer.quality, localizer.particles
    values = {"particles": particles.size, "effective_particles": particles.effective_size}
    if quality is not None:
        values.update(vars(quality))
    return _status("Localization", localizer.is_lost, "lost" if localizer.is_lost else "ok", values)


def _status(task, is_warning, text, values):
    status = DiagnosticStatus(name=f"{rospy.get_name()[1:]}: {task}", hardware_id="None", message=text)
    status.level = DiagnosticStatus.WARN if is_warning else DiagnosticStatus.OK
    status.values = [KeyValue(name, f"{value:g}") for name, value in values.items()]
    return status
