"""Observer of a project: its topics as run events, wherever the project publishes them."""

import math
import struct
from typing import AbstractSet, Any, Callable, Iterator, Set, Tuple

import rosgraph
import rospy
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray

from evaluation.event_stream import EventStream
from evaluation.events import ClockAdvanced, MarkerUpdated
from evaluation.ros.message_events import Reception, marker
from evaluation.ros.run_topics import (
    ACCEPTED_GOALS,
    CLOCK,
    CONTACTS,
    ESTIMATE,
    GOAL_REQUESTS,
    GOAL_RESULTS,
    GOAL_STATUSES,
    TRUTH,
    EventTopic,
    RunTopics,
)
from run_project.judging.run_record import ProjectRunRecord
from run_project.ros.graph_nodes import GraphNodes
from sim_bridge.ros.timing.connection_check import ConnectionCheck

# Size of seq and stamp at the start of a serialized header: they differ between otherwise equal messages.
CHANGING_BYTES = struct.calcsize("<III")
# The usual marker topic; project nodes wait for a subscriber.
MARKERS = "/visualization_marker"
# Nodes whose markers and goals are not those of the project.
ROBOT_NODES = frozenset(("/amcl", "/explore", "/gazebo", "/map_server", "/move_base", "/slam_gmapping"))
QUEUE_SIZE = 100
# Beginnings of the names of our nodes that only receive, and of all nodes that do.
BYSTANDERS = ("run_project", "cockpit")
OBSERVERS = tuple(f"/{name}" for name in ("rviz", *BYSTANDERS))
# Wall time after which actionlib looks again whether the server of an action client is connected [s].
CLIENT_SECONDS = 0.5


class Observer:
    """Publishes the topics of a ROS master as run events, and records them.

    Args:
        log_event: Called with each event that is new, in words.

    Attributes:
        events: The events.
        record: Goals, markers, contacts and distance of the run.
        goal_clients: Nodes of the project that can send goals.
        is_graph_new: Whether topics or services have come or gone between the last two looks, or an action
            client came a short time ago.
        nodes: The nodes that publish.
    """

    def __init__(self, log_event: Callable[[str], None]):
        self.events = EventStream(on_error=lambda text: rospy.logerr("%s", text))
        self.record = ProjectRunRecord(lambda text: log_event(f"{self.simulated_time:7.1f} s  {text}"))
        self.record.attach(self.events)
        self.goal_clients: AbstractSet[str] = frozenset()
        self.is_graph_new = False
        self._client_since = -math.inf
        self.nodes = GraphNodes(lambda name: ConnectionCheck().local_process(name))
        self._topics = RunTopics(self.events, timekeeper=ClockAdvanced)
        self._acting: Set[Tuple[int, str, str]] = set()
        self._seen: Set[str] = set()
        self._goal_topics: Set[str] = set()

    @property
    def simulated_time(self) -> float:
        """Latest time on ``/clock`` [s]."""
        return self.record.simulated_time

    def start(self) -> None:
        """Subscribe to the topics of every run. This process must be a ROS node."""
        self._topics.open((CLOCK, CONTACTS, TRUTH, ESTIMATE))
        rospy.Subscriber("/simulation/pace", String, self._on_pace)
        # Before the project starts: some nodes publish once, as soon as they have a subscriber.
        self._subscribe_markers(MARKERS)
        self._subscribe_goals("/move_base/goal")
        self._subscribe_results("/move_base/result")
        self._seen.update((MARKERS, "/move_base/goal", "/move_base/result"))

    def _on_pace(self, message: String) -> None:
        self.record.pace_rules = message.data.splitlines()

    def discover_topics(self, now: float) -> None:
        """Subscribe to goal, result and marker topics that are new on the master at a wall time [s]."""
        master = rosgraph.Master("/run_project")
        graph = master.getSystemState()
        publishers, _, _ = graph
        self.nodes.update(node for _, nodes in publishers for node in nodes)
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
        clients = {
            node for topic, nodes in publishers if topic in self._goal_topics for node in nodes
        } - ROBOT_NODES
        self._client_since = now if clients - self.goal_clients else self._client_since
        acting = _without_observers(graph)
        self.is_graph_new = acting != self._acting or now - self._client_since < CLIENT_SECONDS
        self._acting, self.goal_clients = acting, clients

    def status(self) -> str:
        """One line for the console: time, distance, latest goal."""
        record = self.record
        goal = f", goal {len(record.goals)} {list(record.goals.values())[-1].status}" if record.goals else ""
        return f"{self.simulated_time:7.1f} s  {record.distance_driven:.1f} m driven{goal}"

    def _subscribe_goals(self, topic: str) -> None:
        self._goal_topics.add(topic)
        self._subscribe(topic, GOAL_REQUESTS)
        server = topic.rsplit("/", 1)[0]
        self._subscribe(f"{server}/status", GOAL_STATUSES)
        self._subscribe(f"{server}/current_goal", ACCEPTED_GOALS)

    def _subscribe_results(self, topic: str) -> None:
        self._subscribe(topic, GOAL_RESULTS)

    def _subscribe_markers(self, topic: str) -> None:
        self._subscribe(topic, EventTopic(topic, rospy.AnyMsg, MarkerReader(), (MarkerUpdated,)))

    def _subscribe(self, topic: str, like: EventTopic) -> None:
        self._topics.subscribe(like._replace(name=topic, queue_size=QUEUE_SIZE))


def _without_observers(graph: Any) -> Set[Tuple[int, str, str]]:
    """The master's tables of publishers, subscribers and services, as table, topic and node."""
    return {
        (table, topic, node)
        for table, entries in enumerate(graph)
        for topic, nodes in entries
        for node in nodes
        if not node.startswith(OBSERVERS)
    }


class MarkerReader:
    """Reads the markers of a topic.

    Messages equal to the last one are skipped: some projects publish a marker a thousand times a second.
    """

    def __init__(self) -> None:
        self._latest = b""

    def __call__(self, raw: rospy.AnyMsg, received: Reception) -> Iterator[MarkerUpdated]:
        data, is_array = raw._buff, raw._connection_header["type"].endswith("Array")
        content = data if is_array else data[CHANGING_BYTES:]
        if content != self._latest:
            self._latest = content
            markers = MarkerArray().deserialize(data).markers if is_array else [Marker().deserialize(data)]
            for each in markers:
                yield marker(each, received)
