"""The node ``slam_gmapping``: between ROS and a Mapper, with the names and habits of gmapping 1.4."""

import math
import threading
from typing import Dict, Optional

import numpy as np
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import MapMetaData
from nav_msgs.srv import LoadMap, LoadMapResponse
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, SetBoolResponse

from planar import PlanarError, Pose2, save_map
from planar.config.parameters import official_names
from planar_ros.messages.conversion import (
    GetMapArrays,
    OccupancyGridArrays,
    frame_name,
    grid_to_msg,
    pose2_from_msg,
    scan_from_msg,
)
from planar_ros.messages.scan_queue import ScanQueue
from planar_ros.messages.transforms import Transforms
from planar_ros.node.parameters import read_settings
from planar_ros.node.progress import Progress
from planar_ros.node.shell import run
from planar_ros.node.waiting import Waiting
from slam_lite.config import WITHOUT_EFFECT, NodeSettings
from slam_lite.mapper import Follower, Mapper
from slam_lite.rendering import MapRenderer, on_canvas
from slam_lite.state import load_state, save_state
from slam_lite.warming import warm_up

ALARM_SECONDS = 15.0
SCAN_QUEUE_SIZE = 5
# A surprise of 3 is normal; odometry that errs several times more than it should is worth a warning.
MEAN_SURPRISE_ALARM = 30.0
SURPRISE_MEMORY = 100
# How far the z axis of a laser may be from straight up or down: gmapping's bound for its height.
PLANAR_TOLERANCE = 1e-3
# The entropy is that of the pose told to this much: 1 cm, 1 cm and 0.01 rad.
ENTROPY_CELL = 1e-6


class SlamNode:
    """Holds one Mapper, or a Follower in localization-only mode, guarded by one lock.

    Scans are dealt with in the queue's thread, loop closures and maps in threads of their own, so that
    neither keeps a scan waiting.
    """

    def __init__(self):
        settings = self._settings = read_settings(
            NodeSettings, official_names(NodeSettings), ignore=[*WITHOUT_EFFECT, "seed"]
        )
        _tell_without_effect()
        self._lock = threading.RLock()
        self._drawing = threading.Lock()
        self._has_keys = threading.Condition(self._lock)
        self._has_map_due = threading.Event()
        self._mapper = Mapper(settings, deferred=True)
        self._follower: Optional[Follower] = None
        self._renderer = MapRenderer(settings.resolution, settings.occupied_threshold)
        self._odom_in_map = Pose2()
        self._base_in_odom: Optional[Pose2] = None
        self._is_paused = False
        self._scan_count = 0
        self._heights: Dict[str, float] = {}
        self._map_stamp = -math.inf
        self._transform_stamp = None
        self._map_message = None
        self._surprise = 0.0
        self._uncertainty = None
        if settings.state:
            self._load(settings.state)
        warm_up()
        self._connect()

    def _connect(self):
        settings = self._settings
        self._map_publisher = rospy.Publisher("map", OccupancyGridArrays, queue_size=1, latch=True)
        self._metadata_publisher = rospy.Publisher("map_metadata", MapMetaData, queue_size=1, latch=True)
        self._entropy_publisher = rospy.Publisher("~entropy", Float64, queue_size=1, latch=True)
        self._progress = Progress()
        self._transforms = Transforms()
        if settings.transform_publish_period > 0.0:
            self._send_transform()
            period = rospy.Duration(settings.transform_publish_period)
            rospy.Timer(period, self._send_transform, reset=True)
        rospy.Service("dynamic_map", GetMapArrays, self._on_dynamic_map)
        rospy.Service("~pause", SetBool, self._on_pause)
        rospy.Service("~save_map", LoadMap, self._on_save_map)
        rospy.Service("~save_state", LoadMap, self._on_save_state)
        rospy.Service("~load_state", LoadMap, self._on_load_state)
        rospy.Subscriber("initialpose", PoseWithCovarianceStamped, self._on_initial_pose, queue_size=2)
        threading.Thread(target=self._close_loops, daemon=True).start()
        threading.Thread(target=self._draw_maps, daemon=True).start()
        rospy.on_shutdown(self._has_map_due.set)
        self._scans = ScanQueue(
            self._transforms,
            settings.odom_frame,
            settings.base_frame,
            self._on_scan,
            self._on_skipped_scan,
            size=SCAN_QUEUE_SIZE,
        )
        Waiting(
            {
                f"a scan on {self._scans.topic}": lambda: self._scan_count > 0,
                f"the transform {settings.odom_frame} -> {settings.base_frame}": self._has_odometry,
            }
        )

    def _on_scan(self, message, scan, base_in_odom):
        self._scan_count += 1
        due = (self._scan_count - 1) % self._settings.throttle_scans == 0
        if due and not self._is_paused and self._is_planar(message.header.frame_id):
            with self._lock:
                self._insert(base_in_odom, scan)
        self._progress.report(message.header.stamp)

    def _is_planar(self, laser_frame):
        if laser_frame not in self._heights:
            mounting = self._transforms.matrix(self._settings.base_frame, laser_frame)
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

    def _insert(self, base_in_odom, scan):
        self._base_in_odom = base_in_odom
        update = (self._follower or self._mapper).insert(base_in_odom, scan)
        if update is not None:
            self._odom_in_map = update.odom_in_map
            self._uncertainty = update.information
            self._watch_odometry(update.surprise)
            self._has_keys.notify_all()
        interval = self._settings.map_update_interval
        if not 0.0 <= scan.stamp - self._map_stamp < interval:
            self._map_stamp = scan.stamp
            self._has_map_due.set()

    def _watch_odometry(self, surprise):
        self._surprise += (min(surprise, 1e3) - self._surprise) / SURPRISE_MEMORY
        if self._surprise > MEAN_SURPRISE_ALARM:
            rospy.logwarn_throttle(
                ALARM_SECONDS,
                "odometry disagrees with the scans (%.0f times the variance promised by srr, srt, str, stt); "
                "the map may suffer where there is little to see",
                self._surprise / 3.0,
            )

    def _on_skipped_scan(self, message, reason):
        settings = self._settings
        mounting = self._transforms.mounting(settings.base_frame, message.header.frame_id)
        if mounting is not None and not self._has_odometry():
            rospy.logwarn_throttle(
                ALARM_SECONDS,
                "no odometry (no transform %s -> %s): mapping from the scans alone",
                settings.odom_frame,
                settings.base_frame,
            )
            self._on_scan(message, scan_from_msg(message, *mounting), Pose2())
            return
        rospy.logwarn_throttle(ALARM_SECONDS, "skipping a scan: %s", reason)
        self._progress.report(message.header.stamp)

    def _close_loops(self):
        while not rospy.is_shutdown():
            with self._lock:
                mapper = self._mapper
                task = mapper.task() if self._follower is None else None
                if task is None:
                    self._has_keys.wait(timeout=1.0)
                    continue
            result = task.run()
            with self._lock:
                if mapper is not self._mapper:
                    continue
                before = mapper.last_in_map
                mapper.adopt(result)
                self._odom_in_map = mapper.last_in_map @ before.inverse() @ self._odom_in_map
                if result.moved:
                    rospy.loginfo("mended the map (%d loop closures so far)", mapper.loop_count)

    def _draw_maps(self):
        while not rospy.is_shutdown():
            self._has_map_due.wait()
            self._has_map_due.clear()
            if not rospy.is_shutdown():
                self._publish_map()

    def _publish_map(self):
        settings = self._settings
        with self._lock:
            renderer, evidence = self._renderer, self._mapper.evidence()
            uncertainty = self._uncertainty
        with self._drawing:
            renderer.update(*evidence)
            grid = on_canvas(renderer.grid(), settings.extent)
        message = grid_to_msg(grid, rospy.Time.now(), frame_name(settings.map_frame))
        self._map_message = message
        self._map_publisher.publish(message)
        self._metadata_publisher.publish(message.info)
        entropy = _entropy(uncertainty)
        if entropy > 0.0:
            self._entropy_publisher.publish(entropy)

    def _send_transform(self, event=None):
        settings = self._settings
        delay = settings.tf_delay if settings.tf_delay >= 0.0 else settings.transform_publish_period
        stamp = rospy.Time.now() + rospy.Duration(delay)
        if stamp == self._transform_stamp:
            return  # a simulated clock may stand still, and tf complains of what it has been told before
        self._transform_stamp = stamp
        map_frame, odom_frame = frame_name(settings.map_frame), frame_name(settings.odom_frame)
        self._transforms.send(self._odom_in_map, map_frame, odom_frame, stamp)

    def _on_dynamic_map(self, request):
        if self._map_message is None:
            raise rospy.ServiceException("there is no map yet")
        response = GetMapArrays._response_class()
        response.map = self._map_message
        return response

    def _on_pause(self, request):
        self._is_paused = request.data
        return SetBoolResponse(success=True, message="paused" if request.data else "mapping")

    def _on_save_map(self, request):
        with self._lock:
            evidence = self._mapper.evidence()
        with self._drawing:
            self._renderer.update(*evidence)
            grid = self._renderer.grid()
        if len(evidence[1]) == 0:
            raise rospy.ServiceException("there is no map yet")
        return self._answer(save_map, grid, _stem(request.map_url))

    def _on_save_state(self, request):
        with self._lock:
            state = self._mapper.state()
        return self._answer(save_state, state, request.map_url)

    def _on_load_state(self, request):
        return self._answer(self._load, request.map_url)

    def _answer(self, act, *arguments):
        try:
            act(*arguments)
        except PlanarError as error:
            rospy.logerr("%s", error)
            raise rospy.ServiceException(str(error)) from None
        return LoadMapResponse(result=LoadMapResponse.RESULT_SUCCESS)

    def _load(self, path):
        state = load_state(path)
        settings = self._settings
        with self._lock:
            self._mapper = Mapper(settings, deferred=True)
            self._mapper.resume(state)
            self._follower = Follower(settings, state) if settings.localization_only else None
            self._renderer = MapRenderer(settings.resolution, settings.occupied_threshold)
        rospy.loginfo("loaded a map of %d scans from %s", len(state.poses), path)

    def _on_initial_pose(self, message):
        if frame_name(message.header.frame_id) != frame_name(self._settings.map_frame):
            rospy.logwarn("ignoring an initial pose in frame %r", message.header.frame_id)
            return
        pose = pose2_from_msg(message.pose.pose)
        with self._lock:
            if self._follower is not None:
                self._follower.place(pose)
            elif len(self._mapper.key_poses):
                self._mapper.resume(self._mapper.state(), pose)
            if self._base_in_odom is not None:
                self._odom_in_map = pose @ self._base_in_odom.inverse()

    def _has_odometry(self):
        return self._transforms.latest_stamp(self._settings.odom_frame, self._settings.base_frame) is not None


def _stem(path: str) -> str:
    return path[: -len(".yaml")] if path.endswith(".yaml") else path


def _entropy(information) -> float:
    """Entropy, nats, of a pose of this information when told to the cell of ENTROPY_CELL."""
    if information is None or np.linalg.det(information) <= 0.0:
        return 0.0
    log_volume = 1.5 * math.log(2.0 * math.pi * math.e) - 0.5 * math.log(np.linalg.det(information))
    return log_volume - math.log(ENTROPY_CELL)


def _tell_without_effect():
    given = [name for name in WITHOUT_EFFECT if rospy.has_param("~" + name)]
    if given:
        rospy.loginfo(
            "no particle filter, so no effect of %s (key_distance, key_angle say which scans are kept)",
            ", ".join(given),
        )


def main():
    run("slam_gmapping", SlamNode)
