"""Records what the report of a run needs, at little cost."""

import time
from typing import Dict, Mapping, Optional

import numpy as np
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry, Path
from rosgraph_msgs.msg import Log
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

from evaluation.ros.referee import CONNECTION_LOG_FILE
from evaluation.ros.subscriptions import subscribe
from evaluation.samples import Samples
from planar import Pose2
from planar.maps.places import NamedPlace
from planar_ros.messages.conversion import (
    OccupancyGridArrays,
    frame_name,
    grid_from_msg,
    pose2_from_msg,
    yaw_of,
)
from run_report import (
    CollisionEvent,
    GoalEvent,
    LoggedWarning,
    MarkerEvent,
    RunRecord,
    StateEvent,
    ZoneRecord,
)

MAX_WARNINGS = 200
MAX_EVENTS, MAX_PLANS, MAX_COLLISIONS = 300, 100, 1000
MAP_FRAME, ODOM_FRAME = "map", "odom"


class RunRecorder:
    """Samples truth, estimate and odometry ten times a simulated second, and keeps the latest events."""

    def __init__(self, places: Mapping[str, NamedPlace]):
        self._places = places
        self._record = RunRecord()
        self._start_wall: Optional[float] = None
        self._now = 0.0
        self._truth, self._odometry, self._estimate = Samples(7), Samples(4), Samples(4)
        self._odom_in_map: Optional[Pose2] = None
        self._map = None
        self._plans_missing = 0
        self._latest_markings: Dict[str, MarkerEvent] = {}

    def start(self) -> None:
        """Subscribe; this process is a node by then."""
        self._record.zones = [
            ZoneRecord(place.name, place.pose.x, place.pose.y, place.pose.yaw, place.radius)
            for place in self._places.values()
        ]
        subscribe("base_pose_ground_truth", Odometry, self._on_truth)
        subscribe("/tf", TFMessage, self._on_transforms)
        subscribe("map", OccupancyGridArrays, self._on_map)
        subscribe("pick_objects/state", String, self._on_state)
        subscribe("contacts", String, self._on_contact)
        subscribe("visualization_marker", Marker, self._on_marker)
        subscribe("move_base/current_goal", PoseStamped, self._on_goal)
        subscribe("move_base/NavfnROS/plan", Path, self._on_plan)
        subscribe("/rosout_agg", Log, self._on_log)

    def record(self) -> RunRecord:
        """Return everything recorded so far."""
        record = self._record
        truth = self._truth.rows()
        record.truth, record.velocity, record.pace = truth[:, :4], truth[:, [0, 4, 5]], truth[:, [0, 6]]
        record.estimate = self._estimate.rows()
        record.odometry = _from_start(self._odometry.rows(), record.truth)
        record.grid = None if self._map is None else grid_from_msg(self._map)
        return record

    def _on_truth(self, message):
        stamp = message.header.stamp.to_sec()
        self._now = stamp
        if not self._truth.is_due(stamp):
            return
        wall = time.monotonic()
        self._start_wall = self._start_wall or wall
        pose, twist = message.pose.pose, message.twist.twist
        self._truth.add(
            stamp,
            pose.position.x,
            pose.position.y,
            yaw_of(pose.orientation),
            twist.linear.x,
            twist.angular.z,
            wall - self._start_wall,
        )

    def _on_transforms(self, message):
        for transform in message.transforms:
            parent = frame_name(transform.header.frame_id)
            if parent == ODOM_FRAME:
                self._on_odometry(transform)
            elif parent == MAP_FRAME and frame_name(transform.child_frame_id) == ODOM_FRAME:
                self._odom_in_map = _pose_of(transform)

    def _on_odometry(self, transform):
        stamp = transform.header.stamp.to_sec()
        if not self._odometry.is_due(stamp):
            return
        base_in_odom = _pose_of(transform)
        self._odometry.add(stamp, base_in_odom.x, base_in_odom.y, base_in_odom.yaw)
        if self._odom_in_map is not None:
            base_in_map = self._odom_in_map @ base_in_odom
            self._estimate.add(stamp, base_in_map.x, base_in_map.y, base_in_map.yaw)

    def _on_map(self, message):
        self._map = message

    def _on_state(self, message):
        self._append(self._record.states, StateEvent(self._now, message.data))

    def _on_contact(self, message):
        for name in message.data.splitlines():
            self._append(self._record.collisions, CollisionEvent(self._now, name), MAX_COLLISIONS)

    def _on_marker(self, message):
        name = f"{message.ns} {message.id}"
        at, is_shown = message.pose.position, message.action == Marker.ADD
        marking = MarkerEvent(self._now, name, is_shown, at.x, at.y)
        latest = self._latest_markings.get(name)
        if latest is None or latest[2:] != marking[2:]:
            self._latest_markings[name] = marking
            self._append(self._record.markings, marking)

    def _on_goal(self, message):
        goal = pose2_from_msg(message.pose)
        self._plans_missing += 1
        self._append(self._record.goals, GoalEvent(self._now, goal.x, goal.y, goal.yaw))

    def _on_plan(self, message):
        """Keep the first plan for each goal; later ones are its remainder."""
        if self._plans_missing:
            self._plans_missing -= 1
            points = [(pose.pose.position.x, pose.pose.position.y) for pose in message.poses]
            self._append(self._record.plans, np.array(points).reshape(-1, 2), MAX_PLANS)

    @staticmethod
    def _append(events: list, event: object, most: int = MAX_EVENTS) -> None:
        """Append an event and drop the oldest of a long run."""
        events.append(event)
        del events[:-most]

    def _on_log(self, message):
        if message.level < Log.WARN or message.file == CONNECTION_LOG_FILE:
            return
        if len(self._record.warnings) < MAX_WARNINGS:
            self._record.warnings.append(LoggedWarning(self._now, message.name.lstrip("/"), message.msg))


def _pose_of(transform) -> Pose2:
    at = transform.transform.translation
    return Pose2(at.x, at.y, yaw_of(transform.transform.rotation))


def _from_start(odometry: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Transform odometry (N, 4) so that it starts at the true start pose."""
    if not len(odometry) or not len(truth):
        return odometry
    nearest = odometry[np.argmin(np.abs(odometry[:, 0] - truth[0, 0]))]
    odom_in_map = Pose2.from_array(truth[0, 1:]) @ Pose2.from_array(nearest[1:]).inverse()
    moved = odometry.copy()
    moved[:, 1:3] = odom_in_map.transform_points(odometry[:, 1:3])
    moved[:, 3] = odometry[:, 3] + odom_in_map.yaw
    return moved
