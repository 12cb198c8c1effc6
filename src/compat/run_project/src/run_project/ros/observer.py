"""Observer of a project: records goals, markers, contacts and the true position of the robot."""

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

# Size of seq and stamp at the start of a serialized header: they differ between otherwise equal messages.
CHANGING_BYTES = struct.calcsize("<III")
# The usual marker topic; project nodes wait for a subscriber.
MARKERS = "/visualization_marker"
# Nodes whose markers and goals are not those of the project.
ROBOT_NODES = frozenset(("/amcl", "/explore", "/gazebo", "/map_server", "/move_base", "/slam_gmapping"))


class Observer:
    """Fills the record of a run from the topics of a ROS master.

    Attributes:
        record: Goals, markers, contacts and distance of the run.
        simulated_time: Latest time on ``/clock`` [s].
        has_goal_clients: Whether a node of the project can send goals.
    """

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
        """Subscribe to the topics of every run. This process must be a ROS node."""
        self._subscribers += [
            rospy.Subscriber("/clock", Clock, self._on_clock, queue_size=1),
            rospy.Subscriber("/contacts", String, self._on_contacts, queue_size=50),
            rospy.Subscriber("/base_pose_ground_truth", Odometry, self._on_ground_truth, queue_size=50),
        ]
        # Before the project starts: some nodes publish once, as soon as they have a subscriber.
        self._subscribe_markers(MARKERS)
        self._subscribe_goals("/move_base/goal")
        self._subscribe_results("/move_base/result")
        self._seen.update((MARKERS, "/move_base/goal", "/move_base/result"))

    def discover_topics(self) -> None:
        """Subscribe to goal, result and marker topics that are new on the master."""
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
            is_of_project = follow != self._subscribe_markers or topic in of_project
            if follow is not None and is_of_project and topic not in self._seen:
                self._seen.add(topic)
                follow(topic)
        self.has_goal_clients = any(
            topic in self._goal_topics and not ROBOT_NODES.issuperset(nodes) for topic, nodes in publishers
        )

    def status(self) -> str:
        """One line for the console: time, distance, latest goal."""
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
        self._update(
            lambda: self.record.add_goal(self.simulated_time, message.goal_id.id, (position.x, position.y))
        )

    def _on_status(self, message):
        for status in message.status_list:
            self._update_status(status)

    def _on_result(self, message):
        self._update_status(message.status)

    def _update_status(self, status):
        name, number, text = status.goal_id.id, status.status, status.text
        self._update(lambda: self.record.update_status(self.simulated_time, name, number, text))

    def _on_marker_message(self, topic: str, raw: rospy.AnyMsg):
        """Skip messages equal to the last one: some projects publish a marker a thousand times a second."""
        data, is_array = raw._buff, raw._connection_header["type"].endswith("Array")
        content = data if is_array else data[CHANGING_BYTES:]
        if self._latest.get(topic) == content:
            return
        self._latest[topic] = content
        for marker in MarkerArray().deserialize(data).markers if is_array else [Marker().deserialize(data)]:
            self._update(partial(self._update_marker, marker))

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
            self._update(partial(self.record.add_collision, name))

    def _update(self, update: Callable[[], Optional[str]]):
        with self._lock:
            event = update()
        if event:
            self._log_event(f"{self.simulated_time:7.1f} s  {event}")
