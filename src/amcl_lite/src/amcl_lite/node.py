"""The node ``amcl``: translates between ROS and a Localizer, with the names and habits of amcl 1.17."""

import math
import threading
import time
from typing import Optional, Tuple

import numpy as np
import rospy
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from nav_msgs.srv import SetMapResponse
from std_srvs.srv import Empty, EmptyResponse

from amcl_lite.config import (
    MOTION_MODELS,
    SENSOR_MODELS,
    InitialPose,
    NodeSettings,
)
from amcl_lite.localizer import Estimate, Localizer, warm_up
from planar import PlanarError, Pose2
from planar.settings import official_names
from planar_ros.messages import (
    GetMapArrays,
    OccupancyGridArrays,
    PosesMsg,
    SetMapArrays,
    frame_name,
    grid_from_msg,
    pose2_from_msg,
    pose2_to_msg,
)
from planar_ros.parameters import read_settings
from planar_ros.progress import Progress
from planar_ros.scan_queue import ScanQueue
from planar_ros.shell import run
from planar_ros.transforms import Transforms
from planar_ros.waiting import Waiting

SCAN_ALARM_SECONDS = 15.0
MAP_RETRY_SECONDS = 0.5
# How long a pose from the past may wait for the odometry that moves it to the present.
POSE_WAIT_SECONDS = 0.5


class AmclNode:
    """Holds one Localizer, guarded by one lock; callbacks hand values to it and publish what it returns."""

    def __init__(self):
        self._settings = _read_settings()
        seed = self._settings.seed
        self._rng = np.random.default_rng(seed if seed >= 0 else None)
        self._lock = threading.RLock()
        self._localizer: Optional[Localizer] = None
        self._pending_pose: Optional[Tuple[Pose2, np.ndarray]] = None
        self._last_estimate: Optional[Estimate] = None
        self._base_in_odom: Optional[Pose2] = None
        self._has_sent_transform = False
        self._has_map = False
        self._last_scan = rospy.Time(0)
        self._saved_at = rospy.Time(0)
        warm_up(self._settings)
        self._connect()

    def _connect(self):
        settings = self._settings
        self._pose_publisher = rospy.Publisher(
            "amcl_pose", PoseWithCovarianceStamped, queue_size=2, latch=True
        )
        self._cloud_publisher = rospy.Publisher("particlecloud", PoseArray, queue_size=2, latch=True)
        self._progress = Progress()
        self._transforms = Transforms()
        rospy.Service("global_localization", Empty, self._on_global_localization)
        rospy.Service("request_nomotion_update", Empty, self._on_request_update)
        rospy.Service("set_map", SetMapArrays, self._on_set_map)
        rospy.Subscriber("initialpose", PoseWithCovarianceStamped, self._on_initial_pose, queue_size=2)
        self._scans = ScanQueue(
            self._transforms, settings.odom_frame, settings.base_frame, self._on_scan, self._on_skipped_scan
        )
        rospy.Timer(rospy.Duration(SCAN_ALARM_SECONDS), self._check_scans)
        rospy.on_shutdown(self._save_pose)
        map_source = f"topic {rospy.resolve_name('map')}"
        if not settings.use_map_topic:
            map_source = f"service {rospy.resolve_name('static_map')}"
        Waiting(
            {
                f"a map from the {map_source}": lambda: self._has_map,
                f"a scan on {self._scans.topic}": lambda: self._last_scan != rospy.Time(0),
                f"the transform {settings.odom_frame} -> {settings.base_frame}": self._has_odometry,
            }
        )
        if settings.use_map_topic:
            rospy.Subscriber("map", OccupancyGridArrays, self._on_map, queue_size=1)

    def fetch_map(self):
        """Gets the map from the service static_map, however long it takes; PlanarError if the map is bad."""
        if self._settings.use_map_topic:
            return
        rospy.loginfo("Requesting the map...")
        static_map = rospy.ServiceProxy("static_map", GetMapArrays)
        while not rospy.is_shutdown():
            try:
                self._install_map(static_map().map)
                return
            except rospy.ServiceException:
                rospy.logwarn_throttle(SCAN_ALARM_SECONDS, "Request for map failed; trying again...")
                time.sleep(MAP_RETRY_SECONDS)

    def _on_map(self, message):
        if self._has_map and self._settings.first_map_only:
            return
        try:
            self._install_map(message)
        except PlanarError as error:
            rospy.logerr("map refused: %s", error)

    def _install_map(self, message):
        info = message.info
        rospy.loginfo("Received a %d X %d map @ %.3f m/pix", info.width, info.height, info.resolution)
        if frame_name(message.header.frame_id) != frame_name(self._settings.map_frame):
            rospy.logwarn(
                "Frame_id of map received:'%s' doesn't match global_frame_id:'%s'. "
                "This could cause issues with reading published topics",
                message.header.frame_id,
                self._settings.map_frame,
            )
        localizer = Localizer(grid_from_msg(message), self._settings, self._rng)
        start = _read_initial_pose()
        localizer.set_pose(start.pose, start.covariance)
        with self._lock:
            self._localizer = localizer
            self._has_map = True
            if self._pending_pose is not None:
                localizer.set_pose(*self._pending_pose)
                self._pending_pose = None
        rospy.loginfo("ready")

    def _on_set_map(self, request):
        try:
            self._install_map(request.map)
        except PlanarError as error:
            rospy.logerr("map refused: %s", error)
            return SetMapResponse(success=False)
        self._take_pose(request.initial_pose, self._settings.force_update_after_set_map)
        return SetMapResponse(success=True)

    def _on_global_localization(self, request):
        with self._lock:
            if self._localizer is not None:
                rospy.loginfo("Initializing with uniform distribution")
                self._localizer.scatter()
        return EmptyResponse()

    def _on_request_update(self, request):
        with self._lock:
            if self._localizer is not None:
                self._localizer.request_update()
        return EmptyResponse()

    def _on_initial_pose(self, message):
        self._take_pose(message, self._settings.force_update_after_initialpose)

    def _take_pose(self, message, force_update):
        frame = frame_name(message.header.frame_id)
        if frame == "":
            rospy.logwarn("Received initial pose with empty frame_id.  You should always supply a frame_id.")
        elif frame != frame_name(self._settings.map_frame):
            rospy.logwarn(
                'Ignoring initial pose in frame "%s"; initial poses must be in the global frame, "%s"',
                frame,
                frame_name(self._settings.map_frame),
            )
            return
        pose = pose2_from_msg(message.pose.pose) @ self._motion_since(message.header.stamp)
        covariance = _planar_covariance(message.pose.covariance)
        if not (pose.is_finite() and np.isfinite(covariance).all()):
            rospy.logwarn("Ignoring initial pose that is not finite")
            return
        rospy.loginfo("Setting pose (%.6f): %.3f %.3f %.3f", rospy.get_time(), pose.x, pose.y, pose.yaw)
        with self._lock:
            if self._localizer is None:
                self._pending_pose = (pose, covariance)
                return
            self._localizer.set_pose(pose, covariance)
            if force_update:
                self._localizer.request_update()

    def _motion_since(self, stamp) -> Pose2:
        """How far the robot has come, by odometry, since ``stamp``; nowhere if that is not known."""
        frames = self._settings.odom_frame, self._settings.base_frame
        base_now = self._transforms.lookup(*frames)
        base_then = None
        if base_now is not None and stamp != rospy.Time(0):
            base_then = self._transforms.lookup(*frames, stamp, POSE_WAIT_SECONDS)
            base_now = self._transforms.lookup(*frames)
        if base_now is None or base_then is None:
            if self._has_sent_transform and stamp != rospy.Time(0):
                rospy.logwarn("Failed to transform initial pose in time (no odometry at its stamp)")
            return Pose2()
        return base_then.inverse() @ base_now

    def _on_scan(self, message, scan, base_in_odom):
        stamp = message.header.stamp
        self._last_scan = rospy.Time.now()
        with self._lock:
            if self._localizer is not None:
                self._base_in_odom = base_in_odom
                self._localize(stamp, scan, base_in_odom, frame_name(message.header.frame_id))
        self._progress.report(stamp)

    def _localize(self, stamp, scan, base_in_odom, laser):
        updates = self._localizer.updates
        try:
            estimate = self._localizer.update(base_in_odom, scan, laser)
        except PlanarError as error:
            rospy.logerr_throttle(SCAN_ALARM_SECONDS, f"scan ignored: {error}")
            return
        if self._localizer.updates != updates:
            self._publish_cloud()
        if estimate is not None:
            self._last_estimate = estimate
            self._publish_pose(estimate, stamp)
        self._send_transform(stamp)
        if estimate is None:
            self._save_pose_if_due()

    def _on_skipped_scan(self, message, reason):
        rospy.logwarn_throttle(SCAN_ALARM_SECONDS, f"Failed to compute odom pose, skipping scan ({reason})")
        self._last_scan = rospy.Time.now()
        self._progress.report(message.header.stamp)

    def _publish_cloud(self):
        poses = self._localizer.particles.poses
        self._cloud_publisher.publish(PosesMsg(poses, rospy.Time.now(), frame_name(self._settings.map_frame)))

    def _publish_pose(self, estimate, stamp):
        message = PoseWithCovarianceStamped()
        message.header.stamp = stamp
        message.header.frame_id = frame_name(self._settings.map_frame)
        message.pose.pose = pose2_to_msg(estimate.base_in_map)
        covariance = np.zeros((6, 6))
        covariance[:2, :2] = estimate.covariance[:2, :2]
        covariance[5, 5] = estimate.covariance[2, 2]
        message.pose.covariance = covariance.ravel().tolist()
        self._pose_publisher.publish(message)

    def _send_transform(self, stamp):
        odom_in_map = self._localizer.odom_in_map
        if odom_in_map is None or not self._settings.tf_broadcast:
            return
        self._transforms.send(
            odom_in_map,
            frame_name(self._settings.map_frame),
            frame_name(self._settings.odom_frame),
            stamp + rospy.Duration(self._settings.transform_tolerance),
        )
        self._has_sent_transform = True

    def _save_pose_if_due(self):
        now = rospy.Time.now()
        rate = self._settings.save_pose_rate
        if rate > 0.0 and abs((now - self._saved_at).to_sec()) >= 1.0 / rate:
            self._saved_at = now
            self._save_pose()

    def _save_pose(self):
        """Lets a restarted node resume where this one was."""
        with self._lock:
            if self._last_estimate is None:
                return
            pose = self._localizer.odom_in_map @ self._base_in_odom
            covariance = self._last_estimate.covariance
        saved = InitialPose(pose.x, pose.y, pose.yaw, *(float(covariance[i, i]) for i in range(3)))
        for name, field in official_names(InitialPose).items():
            rospy.set_param("~" + name, getattr(saved, field))

    def _check_scans(self, event):
        silence = (rospy.Time.now() - self._last_scan).to_sec()
        if silence > SCAN_ALARM_SECONDS:
            rospy.logwarn(
                "No laser scan received (and thus no pose updates have been published) for %f seconds.  "
                "Verify that data is being published on the %s topic.",
                silence,
                self._scans.topic,
            )

    def _has_odometry(self):
        return self._transforms.latest_stamp(self._settings.odom_frame, self._settings.base_frame) is not None


def _read_settings() -> NodeSettings:
    _replace_unknown("odom_model_type", MOTION_MODELS, "odom model type", "diff model")
    _replace_unknown("laser_model_type", SENSOR_MODELS, "laser model type", "likelihood_field model")
    return read_settings(NodeSettings, official_names(NodeSettings), ignore=official_names(InitialPose))


def _replace_unknown(name, known, what, default):
    """amcl warns of an unknown model and takes its first one."""
    value = rospy.get_param("~" + name, known[0])
    if isinstance(value, str) and value not in known:
        rospy.logwarn('Unknown %s "%s"; defaulting to %s', what, value, default)
        rospy.set_param("~" + name, known[0])


def _read_initial_pose() -> InitialPose:
    """The start pose of the parameter server, read at each map since pose saving overwrites it."""
    names = official_names(InitialPose)
    for name in names:
        value = rospy.get_param("~" + name, 0.0)
        if isinstance(value, float) and math.isnan(value):
            rospy.logwarn("ignoring NAN in %s", name)
            rospy.delete_param("~" + name)
    return read_settings(InitialPose, names, ignore=official_names(NodeSettings))


def _planar_covariance(covariance) -> np.ndarray:
    """The (3, 3) of x, y and yaw out of the 36 numbers of a message."""
    whole = np.reshape(covariance, (6, 6))
    planar = np.zeros((3, 3))
    planar[:2, :2] = whole[:2, :2]
    planar[2, 2] = whole[5, 5]
    return planar


def main():
    run("amcl", _start)


def _start():
    node = AmclNode()
    node.fetch_map()
    return node
