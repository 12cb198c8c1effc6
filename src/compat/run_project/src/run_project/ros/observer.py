"""Sees what a project does, from outside: goals and how they end, markers, the true robot."""

import struct
import threading
from functools import partial
from typing import Callable, Dict, List, Optional, Set

import rosgraph
import rospy
from actionlib_msgs.msg import GoalStatusArray
from move_base_msgs.msg import MoveBaseActionGoal, MoveBaseActionResult
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray

from run_project.judging.run_record import ProjectRunRecord

# seq and stamp at the start of a message with a header: what changes when nothing else does.
CHANGING_BYTES = struct.calcsize("<III")
# Most projects' markers; their nodes wait until somebody listens.
MARKERS = "/visualization_marker"
# Their markers are about themselves, not about the project's story.
ROBOT_NODES = frozenset(("/amcl", "/explore", "/gazebo", "/map_server", "/move_base", "/slam_gmapping"))


class Observer:
    """Fills a ledger from the topics that appear on a master; ``say`` is told each piece of news."""

    def __init__(self, log_event: Callable[[str], None]):
        self.record = ProjectRunRecord()
        self.simulated_time = 0.0
        self.has_goal_clients = False
        self._log_event = log_event
        self._lock = threading.Lock()
        self._latest: Dict[str, bytes] = {}
        self._seen: Set[str] = set()
        self._goal_topics: Set[str] = set()
        self._subscribers: List[rospy.Subscriber] = []

    def start(self) -> None:
        """Subscribes to what there always is; this process is a node by then."""
        self._subscribers += [
            rospy.Subscriber("/clock", Clock, self._on_clock, queue_size=1),
            rospy.Subscriber("/contacts", String, self._on_contacts, queue_size=50),
            rospy.Subscriber("/base_pose_ground_truth", Odometry, self._on_ground_truth, queue_size=50),
        ]
        # From the start: what is published as soon as somebody has subscribed would be missed later.
        self._subscribe_markers(MARKERS)
        self._subscribe_goals("/move_base/goal")
        self._subscribe_results("/move_base/result")
        self._seen.update((MARKERS, "/move_base/goal", "/move_base/result"))

    def discover_topics(self) -> None:
        """Subscribes to the topics of interest that are new on the master."""
        master = rosgraph.Master("/run_project")
        publishers, _, _ = master.getSystemState()
        of_project = {topic for topic, nodes in publishers if not ROBOT_NODES.issuperset(nodes)}
        for topic, kind in master.getTopicTypes():
            follow = {
                "move_base_msgs/MoveBaseActionGoal": self._subscribe_goals,
                "move_base_msgs/MoveBaseActionResult": self._subscribe_results,
                "visualization_msgs/Marker": self._subscribe_markers,
                "visualization_msgs/MarkerArray": self._subscribe_markers,
            }.get(kind)
            is_theirs = follow != self._subscribe_markers or topic in of_project
            if follow is not None and is_theirs and topic not in self._seen:
                self._seen.add(topic)
                follow(topic)
        self.has_goal_clients = any(
            topic in self._goal_topics and not ROBOT_NODES.issuperset(nodes) for topic, nodes in publishers
        )

    def status(self) -> str:
        """How things stand, in a line."""
        record = self.record
        goal = f", goal {len(record.goals)} {list(record.goals.values())[-1].status}" if record.goals else ""
        return f"{self.simulated_time:7.1f} s  {record.distance_driven:.1f} m driven{goal}"

    def _subscribe_goals(self, topic):
        self._goal_topics.add(topic)
        self._subscribe(topic, MoveBaseActionGoal, self._on_goal)
        self._subscribe(topic.rsplit("/", 1)[0] + "/status", GoalStatusArray, self._on_status)

    def _subscribe_results(self, topic):
        self._subscribe(topic, MoveBaseActionResult, self._on_result)

    def _subscribe_markers(self, topic):
        self._subscribe(topic, rospy.AnyMsg, lambda raw: self._on_marker_message(topic, raw))

    def _subscribe(self, topic, kind, callback):
        self._subscribers.append(rospy.Subscriber(topic, kind, callback, queue_size=100, tcp_nodelay=True))

    def _on_clock(self, message):
        self.simulated_time = message.clock.to_sec()

    def _on_goal(self, message):
        position = message.goal.target_pose.pose.position
        self._note(
            lambda: self.record.add_goal(self.simulated_time, message.goal_id.id, (position.x, position.y))
        )

    def _on_status(self, message):
        for status in message.status_list:
            self._note_status(status)

    def _on_result(self, message):
        self._note_status(message.status)

    def _note_status(self, status):
        name, number, text = status.goal_id.id, status.status, status.text
        self._note(lambda: self.record.update_status(self.simulated_time, name, number, text))

    def _on_marker_message(self, topic: str, raw: rospy.AnyMsg):
        """Some publish the same marker a thousand times a second: only what differs is looked into."""
        data, is_array = raw._buff, raw._connection_header["type"].endswith("Array")
        content = data if is_array else data[CHANGING_BYTES:]
        if self._latest.get(topic) == content:
            return
        self._latest[topic] = content
        for marker in MarkerArray().deserialize(data).markers if is_array else [Marker().deserialize(data)]:
            self._note(partial(self._update_marker, marker))

    def _update_marker(self, marker: Marker) -> Optional[str]:
        now = self.simulated_time
        if marker.action == Marker.DELETEALL:
            return self.record.delete_all_markers(now)
        scale = marker.scale
        is_visible = marker.color.a > 0.0 or bool(marker.colors)
        is_shown = marker.action == Marker.ADD and is_visible and max(scale.x, scale.y, scale.z) > 0.0
        position = marker.pose.position
        return self.record.update_marker(
            now, (marker.ns, marker.id), (position.x, position.y) if is_shown else None
        )

    def _on_ground_truth(self, message):
        position = message.pose.pose.position
        with self._lock:
            self.record.update_position((position.x, position.y))

    def _on_contacts(self, message):
        for name in message.data.splitlines():
            self._note(partial(self.record.add_collision, name))

    def _note(self, see: Callable[[], Optional[str]]):
        with self._lock:
            news = see()
        if news:
            self._log_event(f"{self.simulated_time:7.1f} s  {news}")
