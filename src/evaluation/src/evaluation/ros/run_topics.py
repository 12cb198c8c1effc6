"""All subscriptions of a judged run: its topics, published as events."""

from functools import partial
from typing import Any, Callable, Iterable, NamedTuple, Optional, Tuple, Type, Union

import rospy
from actionlib_msgs.msg import GoalStatusArray
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from home_service_msgs.msg import (
    DeliverActionGoal,
    ExploreActionFeedback,
    ExploreActionResult,
    MissionState,
)
from move_base_msgs.msg import MoveBaseActionGoal, MoveBaseActionResult
from nav_msgs.msg import Odometry, Path
from rosgraph_msgs.msg import Clock, Log
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

from evaluation import events as kinds
from evaluation.contracts import Consumer
from evaluation.event_stream import EventStream
from evaluation.events import OtherRobotUpdated, RunEvent, TruthUpdated
from evaluation.ros import message_events as read
from evaluation.ros.message_events import Reception
from planar_ros.messages.conversion import OccupancyGridArrays
from planar_ros.node.readiness import WAITING_FOR_TOPIC

SIMULATOR = "/sim_bridge"
OTHER_ROBOTS = ("follower",)
Events = Union[RunEvent, Iterable[RunEvent], None]


class EventTopic(NamedTuple):
    """A topic whose messages are events.

    Attributes:
        name: Its name, relative to the namespace.
        message: Message class.
        read: Converts a message.
        events: Types of its events.
        of_each_robot: Other robots have it, too, in their namespaces.
        queue_size: Messages that may wait; None: without limit.
    """

    name: str
    message: type
    read: Callable[[Any, Reception], Events]
    events: Tuple[Type[RunEvent], ...]
    of_each_robot: bool = False
    queue_size: Optional[int] = None


CLOCK = EventTopic("/clock", Clock, read.clock, (kinds.ClockAdvanced,), queue_size=1)
CONTACTS = EventTopic("contacts", String, read.contacts, (kinds.BodiesTouched,), True)
TRUTH = EventTopic("base_pose_ground_truth", Odometry, read.truth, (TruthUpdated,), True)
ESTIMATE = EventTopic("amcl_pose", PoseWithCovarianceStamped, read.estimate, (kinds.EstimateUpdated,), True)
GOAL_REQUESTS = EventTopic("move_base/goal", MoveBaseActionGoal, read.goal_request, (kinds.GoalRequested,))
ACCEPTED_GOALS = EventTopic(
    "move_base/current_goal", PoseStamped, read.accepted_goal, (kinds.GoalAccepted,), True
)
GOAL_STATUSES = EventTopic("move_base/status", GoalStatusArray, read.statuses, (kinds.GoalStatusUpdated,))
GOAL_RESULTS = EventTopic("move_base/result", MoveBaseActionResult, read.goal_end, (kinds.GoalEnded,), True)
TOPICS = (
    CLOCK,
    CONTACTS,
    TRUTH,
    EventTopic(f"{SIMULATOR}/{WAITING_FOR_TOPIC}", String, read.awaited, (kinds.NodesAwaited,)),
    EventTopic("/simulation/remarks", String, read.remarks, (kinds.RemarksUpdated,)),
    EventTopic("/tf", TFMessage, read.transforms, (kinds.OdometryUpdated, kinds.CorrectionUpdated)),
    ESTIMATE,
    EventTopic("map", OccupancyGridArrays, read.grid, (kinds.MapPublished,)),
    GOAL_REQUESTS,
    GOAL_STATUSES,
    ACCEPTED_GOALS,
    GOAL_RESULTS,
    EventTopic("move_base/NavfnROS/plan", Path, read.plan, (kinds.PlanUpdated,)),
    EventTopic("deliver/goal", DeliverActionGoal, read.mission_request, (kinds.MissionRequested,)),
    EventTopic("pick_objects/mission_state", MissionState, read.mission, (kinds.MissionUpdated,)),
    EventTopic("pick_objects/state", String, read.state, (kinds.StateUpdated,)),
    EventTopic("service/state", String, read.service, (kinds.ServiceUpdated,)),
    EventTopic("visualization_marker", Marker, read.marker, (kinds.MarkerUpdated,)),
    EventTopic("explore/feedback", ExploreActionFeedback, read.exploration, (kinds.ExplorationUpdated,)),
    EventTopic("explore/result", ExploreActionResult, read.exploration_end, (kinds.ExplorationEnded,)),
    EventTopic("bag_player/state", String, read.playback, (kinds.PlaybackUpdated,)),
    EventTopic("/rosout_agg", Log, read.log_line, (kinds.LineLogged,)),
)


class RunTopics:
    """Publishes messages as events. This process must be a node.

    There is one subscription a topic, which is opened when all consumers are attached: rospy shares the
    connection between the subscribers of a process, but hands what has been received on to those only that
    are there by then. Of latched messages, which come first, later subscribers would miss all but the last.

    Args:
        events: Stream to publish to.
        timekeeper: Type of the events whose stamp is the current time.
    """

    def __init__(self, events: EventStream, timekeeper: Type[RunEvent] = TruthUpdated):
        self._events, self._timekeeper = events, timekeeper
        self._now = 0.0

    def open(self, topics: Iterable[EventTopic] = TOPICS) -> None:
        """Subscribe to those topics whose events are consumed."""
        for topic in topics:
            if any(map(self._events.has_consumers_of, topic.events)):
                self.subscribe(topic)
            if topic.of_each_robot and self._events.has_consumers_of(OtherRobotUpdated):
                for robot in OTHER_ROBOTS:
                    self.subscribe(topic._replace(name=f"{robot}/{topic.name}"), robot)

    def subscribe(self, topic: EventTopic, robot: str = "") -> None:
        """Subscribe to a topic.

        Without a limit no message is lost, however long a consumer is delayed. rospy keeps one queue for each
        topic and process, with the length requested last: a short one of another subscriber in this process
        would also cut this one.

        Args:
            topic: The topic.
            robot: Namespace of another robot whose topic it is.
        """
        name = rospy.resolve_name(topic.name)
        handle = partial(self._on_message, topic.read, name, robot)
        rospy.Subscriber(name, topic.message, handle, queue_size=topic.queue_size, tcp_nodelay=True)

    def _on_message(
        self, convert: Callable[[Any, Reception], Events], name: str, robot: str, message: Any
    ) -> None:
        found = convert(message, Reception(self._now, name))
        if isinstance(found, RunEvent):
            self._publish(found, robot)
        elif found is not None:
            for event in found:
                self._publish(event, robot)

    def _publish(self, event: RunEvent, robot: str) -> None:
        if robot:
            self._events.publish(OtherRobotUpdated(event.stamp, robot, event))
            return
        if type(event) is self._timekeeper:
            self._now = event.stamp
        self._events.publish(event)


def observe(*consumers: Consumer) -> None:
    """Attach consumers to the events of the run that this process, a node, belongs to."""
    events = EventStream(on_error=lambda text: rospy.logerr("%s", text))
    for consumer in consumers:
        consumer.attach(events)
    RunTopics(events).open()
