"""The service as a mission: markers, cockpit and judges follow ``pick_objects/mission_state``; its queue."""

import json
from typing import Any, Dict, List, Tuple

import rospy
from home_service_msgs.msg import Delivery, DeliveryState, MissionState, ObjectState
from std_msgs.msg import ColorRGBA, String

from pick_objects.mission import Mission
from planar import Pose2
from planar_ros.messages.conversion import pose2_to_msg
from planar_ros.node.topics import flush_and_close
from service.request_service import RequestService
from service.requests.request import Deliver, Fetch
from service.requests.steps import Drive, DriveToObject, PickUp, SetDown
from service.task import ServiceTask, TaskStatus, task_to_json

# Deliveries, or requests, in a message.
MAX_SHOWN = 50
# Change of the planned end of a request that is published [s].
ESTIMATE_STEP = 5.0
STAGE_OF_STEP = {
    Drive: DeliveryState.FETCHING,
    DriveToObject: DeliveryState.FETCHING,
    PickUp: DeliveryState.PICKING_UP,
    SetDown: DeliveryState.SETTING_DOWN,
}
STAGE_OF_STATUS = {
    TaskStatus.QUEUED: DeliveryState.WAITING,
    TaskStatus.COMPLETED: DeliveryState.DELIVERED,
    TaskStatus.CANCELED: DeliveryState.CANCELLED,
}


class MissionTopics:
    """Publishes changes, latched.

    Args:
        frame_id: Frame of the places.
        mission: Describes objects.
    """

    def __init__(self, frame_id: str, mission: Mission):
        self._frame_id, self._mission = frame_id, mission
        options = {"queue_size": 50, "latch": True}
        self._mission_state = rospy.Publisher("pick_objects/mission_state", MissionState, **options)
        self._state = rospy.Publisher("pick_objects/state", String, **options)
        self._service_state = rospy.Publisher("~state", String, **options)
        self._published: Tuple[Any, ...] = ()
        self._published_queue: Tuple[Any, ...] = ()

    def publish(self, service: RequestService, now: float) -> None:
        """Publish what has changed since the last call; ``now`` is Unix time [s]."""
        state = service.state(now)
        self._publish_queue(service, state)
        stages = tuple((task.id, task.status, task.step) for task in service.book.tasks.values())
        news = (state["activity"], stages[:MAX_SHOWN], tuple(service.book.objects.items()))
        if news == self._published:
            return
        if not self._published or state["activity"] != self._published[0]:
            self._state.publish(state["activity"])
        self._published = news
        self._mission_state.publish(self.message(service, now))

    def flush(self) -> None:
        """Publish the last state to all subscribers."""
        flush_and_close(self._state, self._mission_state, self._service_state)

    def _publish_queue(self, service: RequestService, state: Dict[str, Any]) -> None:
        """Publish battery, activity and the open requests in the order of the plan, if they have changed."""
        charge = None if state["charge"] is None else round(state["charge"], 2)
        tasks = sorted(service.book.tasks.values(), key=_position)
        queue = tuple((each.id, each.status, round((each.estimate or 0.0) / ESTIMATE_STEP)) for each in tasks)
        news = (state["activity"], state["is_docked"], charge, queue)
        if news != self._published_queue:
            self._published_queue = news
            shown = [
                {**task_to_json(each), "text": each.request.description.text} for each in tasks[:MAX_SHOWN]
            ]
            self._service_state.publish(json.dumps({"state": state, "tasks": shown}))

    def message(self, service: RequestService, now: float) -> MissionState:
        """Return the present state."""
        state, current = service.state(now), service.book.tasks.get(service.executor.current)
        open_tasks = list(service.book.tasks.values())
        estimates = [task.estimate for task in open_tasks if task.estimate is not None]
        message = MissionState(
            mission=self._mission.name,
            state=state["activity"],
            delivery="" if current is None else current.id,
            attempt=0 if current is None else current.attempts,
            time_left=max((max(estimates) - now) if estimates else 0.0, 0.0),
            deliveries=delivery_states(open_tasks),
            objects=[
                self._object(name, where, service.book.objects[name].pose)
                for name, where in state["objects"].items()
            ],
        )
        message.header.stamp, message.header.frame_id = rospy.Time.now(), self._frame_id
        return message

    def _object(self, name: str, where: str, pose: Any) -> ObjectState:
        item, is_carried = self._mission.object_named(name), where == "on the robot"
        is_elsewhere = is_carried or where == "left on the way"
        return ObjectState(
            name=name,
            is_carried=is_carried,
            place="" if is_elsewhere else where,
            pose=pose2_to_msg(pose or Pose2()),
            size=item.size,
            color=ColorRGBA(*item.color, 1.0),
            is_solid=item.solid,
        )


def _position(task: ServiceTask) -> Tuple[bool, float]:
    """Return a key by which the task under way comes first, then the others as they are planned."""
    return task.status is not TaskStatus.UNDERWAY, task.estimate or float("inf")


def delivery_states(tasks: List[ServiceTask]) -> List[DeliveryState]:
    """Return the deliveries among tasks."""
    moving = [task for task in tasks if isinstance(task.request.description, (Deliver, Fetch))]
    return [_delivery_state(task) for task in moving[:MAX_SHOWN]]


def _delivery_state(task: ServiceTask) -> DeliveryState:
    description = task.request.description
    stage = STAGE_OF_STATUS.get(task.status, DeliveryState.FAILED)
    if task.status is TaskStatus.UNDERWAY or task.is_carrying:
        step = description.steps()[min(task.step, 3)]
        stage = DeliveryState.CARRYING if task.step == 2 else STAGE_OF_STEP[type(step)]
    source = getattr(description, "source", "")
    moved = Delivery(task.id, task.request.object_name, source, getattr(description, "destination", ""))
    return DeliveryState(moved, stage, task.attempts, task.reason)
