"""Publishes the state of the mission: ``~state`` for people, ``~mission_state`` for programs."""

from typing import Callable, Dict, List, Optional

import rospy
from home_service_msgs import msg
from std_msgs.msg import ColorRGBA, String

from pick_objects.errand import Errand
from pick_objects.job import DeliveryJob, ErrandState
from pick_objects.mission import Delivery
from planar import Pose2
from planar_ros.messages.conversion import pose2_to_msg
from planar_ros.node.topics import flush_and_close


class MissionPublisher:
    """Publishes changes, latched.

    Args:
        frame_id: Frame of the places.
        locate: Returns the estimated pose of the robot in the map.
    """

    def __init__(self, frame_id: str, locate: Callable[[], Pose2]):
        self._frame_id, self._locate = frame_id, locate
        self._state = rospy.Publisher("~state", String, queue_size=10, latch=True)
        self._mission_state = rospy.Publisher("~mission_state", msg.MissionState, queue_size=50, latch=True)
        self._published_state: Optional[ErrandState] = None
        self._announced = ""
        self._published: tuple = ()
        self._dropped_at: Dict[str, Pose2] = {}

    def publish(self, errand: Errand) -> None:
        """Publish and log what has changed since the last call."""
        stages = tuple((job.delivery.name, job.stage) for job in errand.jobs)
        where = errand.place.name if errand.place else ""
        news = (errand, errand.state, where, errand.attempt, stages, tuple(errand.object_locations.items()))
        if news == self._published:
            return
        self._published = news
        self._update_dropped(errand)
        if errand.state is not self._published_state:
            self._published_state = errand.state
            self._state.publish(errand.state.value)
            self._announced = ""
        text = _announcement(errand)
        if (
            text
            and text != self._announced
            and (not self._announced or errand.state is ErrandState.SEARCHING)
        ):
            rospy.loginfo("%s", text)
        self._announced = text
        self._mission_state.publish(self.message(errand))

    def flush(self) -> None:
        """Publish the last state to all subscribers; nothing can be published afterwards."""
        flush_and_close(self._state, self._mission_state)

    def message(self, errand: Errand) -> msg.MissionState:
        """Return the current state as a message."""
        now = rospy.Time.now()
        message = msg.MissionState(
            mission=errand.mission.name,
            state=errand.state.value,
            delivery=errand.job.delivery.name if errand.job else "",
            place=errand.place.name if errand.place else "",
            attempt=errand.attempt,
            progress=errand.progress,
            time_left=errand.time_left(now.to_sec()),
            reason=errand.reason,
            deliveries=delivery_states(errand),
            objects=[self._object_state(errand, name) for name in errand.object_locations],
        )
        message.header.stamp, message.header.frame_id = now, self._frame_id
        return message

    def _object_state(self, errand: Errand, name: str) -> msg.ObjectState:
        location, item = errand.object_locations[name], errand.mission.object_named(name)
        return msg.ObjectState(
            name=name,
            is_carried=location.is_carried,
            place=location.place or "",
            pose=pose2_to_msg(self._dropped_at.get(name, location.pose)),
            size=item.size,
            color=ColorRGBA(*item.color, 1.0),
            is_solid=item.solid,
        )

    def _update_dropped(self, errand: Errand) -> None:
        """Locate objects that the robot had to leave at the robot's pose of that moment."""
        left = [
            name
            for name, location in errand.object_locations.items()
            if location.place is None and not location.is_carried
        ]
        self._dropped_at = {name: self._dropped_at.get(name, self._locate()) for name in left}


def delivery_states(errand: Errand) -> List[msg.DeliveryState]:
    return [
        msg.DeliveryState(delivery_msg(job.delivery), job.stage.value, job.attempts, job.reason)
        for job in errand.jobs
    ]


def delivery_msg(delivery: Delivery) -> msg.Delivery:
    return msg.Delivery(delivery.name, delivery.object_name, delivery.source, delivery.destination)


def delivery_from_msg(message: msg.Delivery) -> Delivery:
    return Delivery(message.name, message.object, message.source, message.destination)


def _announcement(errand: Errand) -> str:
    job, place = errand.job, errand.place
    if job is None or place is None:
        return ""
    text = {
        ErrandState.SEARCHING: f"searching {job.delivery.object_name}: driving to {place.name}",
        ErrandState.GOING_TO_PICKUP: f"driving to {place.name}",
        ErrandState.PICKING_UP: f"arrived at {place.name}, picking up",
        ErrandState.GOING_TO_DROPOFF: f"picked up, driving to {place.name}",
        ErrandState.SETTING_DOWN: f"arrived at {place.name}, setting down",
        ErrandState.DELIVERED: job.reason or f"arrived at {place.name}, delivered",
        ErrandState.FAILED: "the mission has failed",
        ErrandState.CANCELLED: "the mission is cancelled",
    }.get(errand.state, errand.state.value)
    return _of_delivery(errand, job) + text


def _of_delivery(errand: Errand, job: DeliveryJob) -> str:
    is_one_of_many = len(errand.jobs) > 1 and not errand.reason
    return f"{job.delivery.name} ({job.delivery.object_name}): " if is_one_of_many else ""
