"""Messages as run events."""

import json
from functools import partial
from typing import Any, Iterator, Mapping, NamedTuple, Optional, Tuple

import numpy as np
from rosgraph_msgs.msg import Log
from visualization_msgs.msg import Marker

from evaluation.events import (
    BodiesTouched,
    ClockAdvanced,
    CorrectionUpdated,
    DeliveryProgress,
    EstimateUpdated,
    ExplorationEnded,
    ExplorationUpdated,
    GoalAccepted,
    GoalEnded,
    GoalRequested,
    GoalStatusUpdated,
    LineLogged,
    MapPublished,
    MarkerUpdated,
    MissionRequested,
    MissionUpdated,
    NodesAwaited,
    OdometryUpdated,
    PlanUpdated,
    PlaybackUpdated,
    Publication,
    RemarksUpdated,
    RunEvent,
    ServiceUpdated,
    StateUpdated,
    TruthUpdated,
)
from pick_objects import Delivery, DeliveryStage
from planar import Pose2, Twist2
from planar_ros.messages.conversion import frame_name, grid_from_msg, pose2_from_msg, yaw_of

MAP_FRAME, ODOM_FRAME = "map", "odom"
# File of rospy whose lines about connections are left out.
CONNECTION_LOG_FILE = "tcpros_base.py"
# Line of rviz about the shader of its map display, logged as an error in every run and without consequence.
SHADER_COMPLAINT = "GLSL link result"


class Reception(NamedTuple):
    """When and where a message was received.

    Attributes:
        stamp: Latest simulated time [s], the stamp of events whose messages have none.
        topic: Resolved topic.
    """

    stamp: float
    topic: str


def clock(message: Any, received: Reception) -> ClockAdvanced:
    return ClockAdvanced(message.clock.to_sec())


def awaited(message: Any, received: Reception) -> NodesAwaited:
    return NodesAwaited(received.stamp, tuple(message.data.splitlines()))


def remarks(message: Any, received: Reception) -> RemarksUpdated:
    return RemarksUpdated(received.stamp, tuple(message.data.splitlines()))


def truth(message: Any, received: Reception) -> TruthUpdated:
    pose, twist = message.pose.pose, message.twist.twist
    return TruthUpdated(
        message.header.stamp.to_sec(),
        pose2_from_msg(pose),
        Twist2(twist.linear.x, twist.angular.z),
        _publication(message, received, pose),
    )


def estimate(message: Any, received: Reception) -> EstimateUpdated:
    pose = message.pose.pose
    return EstimateUpdated(
        message.header.stamp.to_sec(), pose2_from_msg(pose), _publication(message, received, pose)
    )


def transforms(message: Any, received: Reception) -> Iterator[RunEvent]:
    """Yield odometry and its correction."""
    for transform in message.transforms:
        parent = frame_name(transform.header.frame_id)
        if parent == ODOM_FRAME:
            yield OdometryUpdated(transform.header.stamp.to_sec(), _pose_of(transform))
        elif parent == MAP_FRAME and frame_name(transform.child_frame_id) == ODOM_FRAME:
            yield CorrectionUpdated(transform.header.stamp.to_sec(), _pose_of(transform))


def contacts(message: Any, received: Reception) -> BodiesTouched:
    return BodiesTouched(received.stamp, tuple(message.data.splitlines()))


def goal_request(message: Any, received: Reception) -> GoalRequested:
    target = message.goal.target_pose
    return GoalRequested(
        received.stamp, message.goal_id.id, target.header.frame_id, pose2_from_msg(target.pose)
    )


def accepted_goal(message: Any, received: Reception) -> GoalAccepted:
    return GoalAccepted(
        received.stamp, pose2_from_msg(message.pose), _publication(message, received, message.pose)
    )


def statuses(message: Any, received: Reception) -> Iterator[GoalStatusUpdated]:
    for status in message.status_list:
        yield GoalStatusUpdated(received.stamp, status.goal_id.id, status.status, status.text)


def goal_end(message: Any, received: Reception) -> GoalEnded:
    status = message.status
    return GoalEnded(
        message.header.stamp.to_sec(),
        status.goal_id.id,
        status.status,
        status.text,
        _publication(message, received),
    )


def plan(message: Any, received: Reception) -> PlanUpdated:
    points = [(pose.pose.position.x, pose.pose.position.y) for pose in message.poses]
    return PlanUpdated(received.stamp, np.array(points).reshape(-1, 2))


def mission_request(message: Any, received: Reception) -> MissionRequested:
    return MissionRequested(received.stamp, message.goal.mission)


def mission(message: Any, received: Reception) -> MissionUpdated:
    objects = {each.name: (each.pose.position.x, each.pose.position.y) for each in message.objects}
    deliveries = tuple(_delivery(each, objects) for each in message.deliveries)
    return MissionUpdated(
        message.header.stamp.to_sec(),
        message.state,
        deliveries,
        message.reason,
        message.place,
        message.attempt,
        _publication(message, received),
    )


def _delivery(message: Any, objects: Mapping[str, Tuple[float, float]]) -> DeliveryProgress:
    named = message.delivery
    delivery = Delivery(named.name, named.object, named.source, named.destination)
    stage, object_at = DeliveryStage(message.state), objects.get(named.object)
    return DeliveryProgress(delivery, stage, message.attempts, message.reason, object_at)


def state(message: Any, received: Reception) -> StateUpdated:
    return StateUpdated(received.stamp, message.data)


def service(message: Any, received: Reception) -> ServiceUpdated:
    return ServiceUpdated(received.stamp, json.loads(message.data)["state"]["charge"])


def marker(message: Marker, received: Reception) -> MarkerUpdated:
    at, scale = message.pose.position, message.scale
    has_colour = message.color.a > 0.0 or bool(message.colors)
    return MarkerUpdated(
        received.stamp,
        message.ns,
        message.id,
        (at.x, at.y, at.z),
        message.action,
        bool(message.frame_locked),
        has_colour and max(scale.x, scale.y, scale.z) > 0.0,
    )


def grid(message: Any, received: Reception) -> MapPublished:
    return MapPublished(received.stamp, partial(grid_from_msg, message))


def log_line(message: Log, received: Reception) -> Optional[LineLogged]:
    if message.file == CONNECTION_LOG_FILE:
        return None
    is_warning = message.level >= Log.WARN and SHADER_COMPLAINT not in message.msg
    return LineLogged(received.stamp, message.name.lstrip("/"), message.msg, is_warning)


def exploration(message: Any, received: Reception) -> ExplorationUpdated:
    feedback = message.feedback
    return ExplorationUpdated(received.stamp, feedback.state, feedback.explored_area, feedback.frontiers)


def exploration_end(message: Any, received: Reception) -> ExplorationEnded:
    status = message.status
    return ExplorationEnded(
        message.header.stamp.to_sec(), status.status, status.text, _publication(message, received)
    )


def playback(message: Any, received: Reception) -> PlaybackUpdated:
    return PlaybackUpdated(received.stamp, message.data)


def _publication(message: Any, received: Reception, pose: Any = None) -> Publication:
    node = message._connection_header["callerid"]
    rotation = (0.0, 1.0) if pose is None else (pose.orientation.z, pose.orientation.w)
    return Publication(message.header.stamp.to_nsec(), received.topic, node, rotation)


def _pose_of(transform: Any) -> Pose2:
    at = transform.transform.translation
    return Pose2(at.x, at.y, yaw_of(transform.transform.rotation))
