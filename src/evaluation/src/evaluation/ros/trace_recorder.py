"""Records the trace of a run, and what may keep the run from being repeatable."""

from typing import Any, Callable, List

import rospy
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from home_service_msgs.msg import ExploreActionResult, MissionState
from move_base_msgs.msg import MoveBaseActionResult
from nav_msgs.msg import Odometry
from std_msgs.msg import String
from visualization_msgs.msg import Marker

from evaluation.result import ResultFile
from evaluation.ros.subscriptions import subscribe
from evaluation.trace import FILE, Trace, TraceEntry, hash_of, write_trace

ROBOTS = ("", "follower/")


class TraceRecorder:
    """Subscribes to the topics of the trace."""

    def __init__(self):
        self._trace = Trace()
        self._remarks: List[str] = []

    def start(self) -> None:
        """Subscribe; this process is a node by then."""
        for robot in ROBOTS:
            self._record(f"{robot}base_pose_ground_truth", Odometry, _pose)
            self._record(f"{robot}amcl_pose", PoseWithCovarianceStamped, _pose)
            self._record(f"{robot}move_base/current_goal", PoseStamped, _goal, self._start)
            self._record(f"{robot}move_base/result", MoveBaseActionResult, _result)
        self._record("move_base/result", MoveBaseActionResult, _result, self._trace.end)
        self._record("pick_objects/mission_state", MissionState, _mission, self._trace.end)
        self._record("explore/result", ExploreActionResult, _result, self._trace.end)
        subscribe("visualization_marker", Marker, self._on_marker)
        subscribe("/simulation/remarks", String, self._on_remarks)

    def save(self, result: ResultFile) -> None:
        """Add hash and repeatability to a result and write the trace, if anything was driven."""
        with result.recording_gaps(FILE):
            content = self._trace.content()
            if content:
                result.add(hash=hash_of(content))
                result.add(repeatable=not self._remarks, not_repeatable_because=self._remarks)
                write_trace(result.folder, content)

    def _record(
        self,
        topic: str,
        kind: type,
        describe: Callable[[Any], str],
        also: Callable[[TraceEntry], None] = lambda entry: None,
    ) -> None:
        def keep(message: Any) -> None:
            node = message._connection_header["callerid"]
            entry = TraceEntry(
                message.header.stamp.to_nsec(), rospy.resolve_name(topic), node, describe(message)
            )
            self._trace.add(entry)
            also(entry)

        subscribe(topic, kind, keep)

    def _start(self, entry: TraceEntry) -> None:
        self._trace.start(entry.stamp)

    def _on_marker(self, message: Marker) -> None:
        at = message.pose.position
        self._trace.add_unstamped(
            f"marker {message.ns} {message.id}: {message.action} at {at.x!r} {at.y!r} {at.z!r}"
        )

    def _on_remarks(self, message: String) -> None:
        self._remarks = message.data.splitlines()


def _pose(message: Any) -> str:
    at, turned = message.pose.pose.position, message.pose.pose.orientation
    return f"{at.x!r} {at.y!r} {turned.z!r} {turned.w!r}"


def _goal(message: PoseStamped) -> str:
    at, turned = message.pose.position, message.pose.orientation
    return f"{at.x!r} {at.y!r} {turned.z!r} {turned.w!r}"


def _result(message: Any) -> str:
    return f"{message.status.status} {message.status.text!r}"


def _mission(message: MissionState) -> str:
    stages = ", ".join(f"{each.delivery.name}: {each.state}" for each in message.deliveries)
    return f"{message.state!r} at {message.place!r}, attempt {message.attempt} ({stages})"
