"""The node ``amcl``: translates between ROS and a Localizer, with the names and habits of amcl 1.17.

amcl_lite
amcl_lite --explain-params
amcl_lite --run-from-bag BAG [--global-localization]
"""

import argparse
import threading
import time
from pathlib import Path
from typing import Optional, Tuple

import numpy as np
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.srv import SetMapResponse
from std_srvs.srv import Empty, EmptyResponse

from amcl_lite.config import CONFIG_FILES, MOTION_MODELS, SENSOR_MODELS, InitialPose, NodeSettings, advice
from amcl_lite.localizer import Estimate, Localizer, warm_up
from amcl_lite.ros.start_pose import PoseKeeper, read_start_pose
from amcl_lite.ros.views import Views
from planar import PlanarError, Pose2, Scan, SettingsError
from planar.config.listing import yaml_of
from planar.config.parameters import official_names
from planar.config.settings import settings_from
from planar_ros.messages.conversion import (
    GetMapArrays,
    OccupancyGridArrays,
    SetMapArrays,
    frame_name,
    grid_from_msg,
    pose2_from_msg,
)
from planar_ros.messages.scan_queue import ScanQueue
from planar_ros.messages.transforms import Transforms
from planar_ros.node.parameters import read_settings
from planar_ros.node.progress import Progress
from planar_ros.node.reconfigure import RESTORE, Reconfiguration, dynamic_values
from planar_ros.node.shell import run
from planar_ros.node.waiting import Waiting

SCAN_ALARM_SECONDS = 15.0
MAP_RETRY_SECONDS = 0.5
# How long a pose from the past may wait for the odometry that moves it to the present.
POSE_WAIT_SECONDS = 0.5


class AmclNode:
    """Holds one Localizer, guarded by one lock; callbacks hand values to it and publish what it returns."""

    def __init__(self, scan_topic: str = "scan"):
        self._settings = _read_settings()
        seed = self._settings.seed
        self._rng = np.random.default_rng(seed if seed >= 0 else None)
        self._lock = threading.RLock()
        self._localizer: Optional[Localizer] = None
        self._pending_pose: Optional[Tuple[Pose2, np.ndarray]] = None
        self._last_estimate: Optional[Estimate] = None
        self._base_in_odom: Optional[Pose2] = None
        self._last_scan = rospy.Time(0)
        self._has_sent_transform = False
        _warm_up(self._settings)
        self._views = Views(self._settings)
        self._keeper = PoseKeeper()
        self._progress = Progress()
        self._transforms = Transforms()
        settings = self._settings
        self._scans = ScanQueue(
            self._transforms,
            settings.odom_frame,
            settings.base_frame,
            self._on_scan,
            self._on_skipped_scan,
            scan_topic,
        )
        self._listen()
        self._say_what_is_missing()
        Reconfiguration(self._settings, self._on_reconfigure)

    def _listen(self):
        rospy.Service("global_localization", Empty, self._on_global_localization)
        rospy.Service("request_nomotion_update", Empty, self._on_request_update)
        rospy.Service("set_map", SetMapArrays, self._on_set_map)
        rospy.Subscriber("initialpose", PoseWithCovarianceStamped, self._on_initial_pose, queue_size=2)
        if self._settings.use_map_topic:
            rospy.Subscriber("map", OccupancyGridArrays, self._on_map, queue_size=1)
        rospy.Timer(rospy.Duration(SCAN_ALARM_SECONDS), self._check_scans, reset=True)  # time may jump back
        rospy.on_shutdown(self._keep_pose)

    def _say_what_is_missing(self):
        source = f"service {rospy.resolve_name('static_map')}"
        if self._settings.use_map_topic:
            source = f"topic {rospy.resolve_name('map')}"
        frames = self._settings.odom_frame, self._settings.base_frame
        Waiting(
            {
                f"a map from the {source}": lambda: self._localizer is not None,
                f"a scan on {self._scans.topic}": lambda: self._scans.has_received,
                "the transform {} -> {}".format(*frames): lambda: self._transforms.latest_stamp(*frames)
                is not None,
            }
        )

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

    def run_from_bag(self, path: str, localize_globally: bool):
        """Works through a bag, says where the robot is in the end, and ends the node."""
        while self._localizer is None and not rospy.is_shutdown():
            time.sleep(MAP_RETRY_SECONDS)
        if localize_globally:
            self._on_global_localization(None)
        from amcl_lite.ros.bag_player import play_bag  # rosbag takes memory, and is rarely wanted

        start = time.monotonic()
        play_bag(Path(path), self._transforms, self._scans, self._settings.bag_scan_period)
        rospy.loginfo("Bag complete, took %.1f seconds to process, shutting down", time.monotonic() - start)
        if self._last_estimate is not None:
            pose = self._last_estimate.base_in_map
            place = pose.x, pose.y, pose.yaw, self._estimate_stamp.to_sec()
            rospy.loginfo("Final location %.3f, %.3f, %.3f with stamp=%f", *place)
        rospy.signal_shutdown("bag complete")

    def _on_map(self, message):
        if self._localizer is not None and self._settings.first_map_only:
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
        start = read_start_pose()
        localizer.set_pose(start.pose, start.covariance)
        with self._lock:
            if self._pending_pose is not None:
                localizer.set_pose(*self._pending_pose)
                self._pending_pose = None
            self._localizer = localizer
        self._views.show_field(localizer.fit_grid)

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
            rospy.logwarn("Ignoring an initial pose that is not finite")
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
        if stamp == rospy.Time(0):
            return Pose2()
        base_then = self._transforms.lookup(*frames, stamp, POSE_WAIT_SECONDS)
        base_now = self._transforms.lookup(*frames)
        if base_now is None or base_then is None:
            if self._has_sent_transform:
                rospy.logwarn("Failed to transform initial pose in time (no odometry at its stamp)")
            return Pose2()
        return base_then.inverse() @ base_now

    def _on_scan(self, message, scan, base_in_odom):
        stamp, laser = message.header.stamp, frame_name(message.header.frame_id)
        self._last_scan = rospy.Time.now()
        with self._lock:
            if self._localizer is not None:
                try:
                    self._localize(self._localizer, stamp, scan, base_in_odom, laser)
                except PlanarError as error:
                    rospy.logerr_throttle(SCAN_ALARM_SECONDS, f"scan ignored: {error}")
        self._progress.report(stamp)

    def _localize(self, localizer: Localizer, stamp, scan: Scan, base_in_odom: Pose2, laser: str) -> None:
        updates = localizer.updates
        estimate = localizer.update(base_in_odom, scan, laser)
        self._base_in_odom = base_in_odom
        if localizer.updates != updates:
            self._views.show_particles(localizer)
        if estimate is not None:
            self._last_estimate, self._estimate_stamp = estimate, stamp
            self._views.show_estimate(estimate, stamp)
        if localizer.odom_in_map is None or self._last_estimate is None:  # which come together
            return
        self._send_transform(localizer.odom_in_map, stamp)
        self._views.show_quality(localizer)
        self._views.show_diagnostics(localizer, self._last_estimate)
        if estimate is None:
            self._keeper.keep_if_due(
                self._settings.save_pose_rate,
                localizer.odom_in_map @ base_in_odom,
                self._last_estimate.covariance,
            )

    def _on_skipped_scan(self, message, reason):
        rospy.logwarn_throttle(SCAN_ALARM_SECONDS, f"Failed to compute odom pose, skipping scan ({reason})")
        self._last_scan = rospy.Time.now()
        self._progress.report(message.header.stamp)

    def _send_transform(self, odom_in_map, stamp):
        settings = self._settings
        if settings.tf_broadcast:
            expiry = stamp + rospy.Duration(settings.transform_tolerance)
            frames = frame_name(settings.map_frame), frame_name(settings.odom_frame)
            self._transforms.send(odom_in_map, *frames, expiry)
            self._has_sent_transform = True

    def _keep_pose(self):
        """Before the node ends: a restarted one resumes where this one was."""
        with self._lock:
            odom_in_map = None if self._localizer is None else self._localizer.odom_in_map
            base_in_odom, estimate = self._base_in_odom, self._last_estimate
            if odom_in_map is not None and base_in_odom is not None and estimate is not None:
                self._keeper.keep(odom_in_map @ base_in_odom, estimate.covariance)

    def _on_reconfigure(self, values):
        """dynamic_reconfigure: as in amcl, the filter starts anew around the last estimate."""
        if values["min_particles"] > values["max_particles"]:
            rospy.logwarn(
                "You've set min_particles to be greater than max particles, this isn't allowed so they'll be "
                "set to be equal."
            )
            values = {**values, "max_particles": values["min_particles"]}
        names = official_names(NodeSettings)
        running = {name: getattr(self._settings, field) for name, field in names.items()}
        try:
            settings, _ = settings_from(NodeSettings, {**running, **values}, names)
        except SettingsError as error:
            rospy.logerr("refused: %s", error)
            return dynamic_values(self._settings)
        with self._lock:
            self._settings = self._views.settings = settings
            self._scans.use_frames(settings.odom_frame, settings.base_frame)
            if self._localizer is not None:
                self._localizer.reconfigure(settings)
        return dynamic_values(settings)

    def _check_scans(self, event):
        silence = (rospy.Time.now() - self._last_scan).to_sec()
        if silence > SCAN_ALARM_SECONDS:
            rospy.logwarn(
                "No laser scan received (and thus no pose updates have been published) for %f seconds.  "
                "Verify that data is being published on the %s topic.",
                silence,
                self._scans.topic,
            )


def _warm_up(settings) -> None:
    """Compiles or loads the kernels, before any scan comes; says so if that takes long."""
    is_warm = threading.Event()
    Waiting({"its kernels to be compiled, as after each installation": is_warm.is_set})
    warm_up(settings)
    is_warm.set()


def _read_settings() -> NodeSettings:
    _replace_unknown("odom_model_type", MOTION_MODELS, "odom model type", "diff model")
    _replace_unknown("laser_model_type", SENSOR_MODELS, "laser model type", "likelihood_field model")
    settings = read_settings(
        NodeSettings, official_names(NodeSettings), ignore=(*official_names(InitialPose), RESTORE)
    )
    for line in advice(settings):
        rospy.logwarn(line)
    return settings


def _replace_unknown(name, known, what, default):
    """amcl warns of an unknown model and takes its first one."""
    value = rospy.get_param("~" + name, known[0])
    if isinstance(value, str) and value not in known:
        rospy.logwarn('Unknown %s "%s"; defaulting to %s', what, value, default)
        rospy.set_param("~" + name, known[0])


def _planar_covariance(covariance) -> np.ndarray:
    """The (3, 3) of x, y and yaw out of the 36 numbers of a message."""
    whole = np.reshape(covariance, (6, 6))
    planar = np.zeros((3, 3))
    planar[:2, :2] = whole[:2, :2]
    planar[2, 2] = whole[5, 5]
    return planar


def main():
    parser = argparse.ArgumentParser(prog="amcl_lite", description="Localizes a robot in a known map.")
    parser.add_argument("--explain-params", action="store_true", help="print all parameters, with meanings")
    parser.add_argument("--run-from-bag", metavar="BAG", help="work through topics tf and base_scan of a bag")
    parser.add_argument("--global-localization", action="store_true", help="of the bag the start is unknown")
    arguments = parser.parse_args(rospy.myargv()[1:])
    if arguments.explain_params:
        print(yaml_of(CONFIG_FILES["amcl_lite.yaml"]), end="")
        return
    run("amcl", lambda: _start(arguments))


def _start(arguments):
    node = AmclNode("base_scan" if arguments.run_from_bag else "scan")
    node.fetch_map()
    if arguments.run_from_bag:
        node.run_from_bag(arguments.run_from_bag, arguments.global_localization)
    return node
