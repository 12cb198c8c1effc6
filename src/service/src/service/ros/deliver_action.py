"""Requests over ROS: the action ``deliver``, services of pick_objects, and a topic."""

import json
import uuid
from typing import Any, Dict, List

import rospy
from home_service_msgs.msg import DeliverAction, DeliverFeedback, DeliverGoal, DeliverResult
from home_service_msgs.srv import AddDelivery, AddDeliveryResponse, CancelDelivery, CancelDeliveryResponse
from std_msgs.msg import String

from pick_objects import Mission, MissionError, parse_mission
from planar import PlanarError
from planar_ros.calls.actions import ActionServer
from service.errors import RequestError
from service.host import ServiceHost, cancel, submit
from service.requests.mission_requests import documents_of
from service.ros.mission_topics import MissionTopics, delivery_states
from service.task import TaskStatus

# Wall-clock time within which the service answers [s].
ANSWER_SECONDS = 20.0


class RosRequests:
    """Accepts requests over ROS.

    Args:
        host: The service.
        mission: Places and objects that goals may refer to.
        topics: Makes the feedback.
    """

    def __init__(self, host: ServiceHost, mission: Mission, topics: MissionTopics):
        self._host, self._mission, self._topics = host, mission, topics
        self._tasks: List[str] = []
        self._server = ActionServer("deliver", DeliverAction, auto_start=False)
        self._server.start()
        rospy.Subscriber("~request", String, self._on_request, queue_size=100)
        rospy.Service("pick_objects/add_delivery", AddDelivery, self._on_add)
        rospy.Service("pick_objects/cancel_delivery", CancelDelivery, self._on_cancel)

    def update(self, now: float) -> None:
        """Advance the goal of the action; in the service's thread, at Unix time ``now`` [s]."""
        service = self._host.service
        if service is None:
            return
        if self._server.is_new_goal_available():
            self._accept(self._server.accept_new_goal(), now)
        if not self._server.is_active():
            return
        if self._server.is_preempt_requested():
            for task_id in self._tasks:
                if task_id in service.book.tasks:
                    service.cancel(task_id, now)
        ended = [service.find(task_id) for task_id in self._tasks]
        if any(task.is_open for task in ended):
            self._server.publish_feedback(DeliverFeedback(self._topics.message(service, now)))
            return
        done = sum(task.status is TaskStatus.COMPLETED for task in ended)
        text = f"{done} of {len(ended)} delivered"
        result = DeliverResult(text, delivery_states(ended), rospy.Duration(0))
        if done == len(ended):
            self._server.set_succeeded(result, text)
        elif self._server.is_preempt_requested():
            self._server.set_preempted(result, text)
        else:
            self._server.set_aborted(result, text)

    def _accept(self, goal: DeliverGoal, now: float) -> None:
        service = self._host.service
        assert service is not None
        try:
            documents = self._documents(goal)
            self._tasks = [service.submit(document, now).id for document in documents]
        except PlanarError as error:
            rospy.logwarn("a mission is refused: %s", error)
            self._server.set_aborted(DeliverResult(reason=str(error)), str(error))

    def _documents(self, goal: DeliverGoal) -> List[Dict[str, Any]]:
        if goal.mission:
            if goal.deliveries:
                raise MissionError("a goal holds either a mission or deliveries, not both")
            prefix = f"goal-{uuid.uuid4().hex[:12]}"
            return documents_of(parse_mission(goal.mission, self._mission.places), prefix)
        if not goal.deliveries:
            raise MissionError("the goal holds neither a mission nor deliveries")
        return [_document(delivery) for delivery in goal.deliveries]

    def _on_add(self, request: Any) -> AddDeliveryResponse:
        return self._answer(submit(_document(request.delivery)), AddDeliveryResponse)

    def _on_cancel(self, request: Any) -> CancelDeliveryResponse:
        return self._answer(cancel(request.name), CancelDeliveryResponse)

    def _answer(self, act: Any, kind: Any) -> Any:
        try:
            self._host.call(act).result(ANSWER_SECONDS)
        except (PlanarError, TimeoutError) as error:
            return kind(False, str(error) or f"no answer within {ANSWER_SECONDS:g} s")
        return kind(True, "")

    def _on_request(self, message: String) -> None:
        """A line of text, or JSON."""
        try:
            document = (
                json.loads(message.data) if message.data.lstrip().startswith("{") else {"text": message.data}
            )
        except (ValueError, RecursionError) as error:
            rospy.logwarn("%s: no JSON (%s)", rospy.resolve_name("~request"), error)
            return
        answer = self._host.call(submit(document))
        answer.add_done_callback(_log_refusal)


def _log_refusal(answer: Any) -> None:
    error = answer.exception()
    if error is not None:
        rospy.logwarn("%s: refused: %s", rospy.resolve_name("~request"), error)


def _document(message: Any) -> Dict[str, Any]:
    values = {"object": message.object, "from": message.source, "to": message.destination}
    unsourced = "fetch" if message.destination else "find"
    category = "deliver" if message.source else unsourced
    description = {name: value for name, value in values.items() if value}
    if not message.object:
        raise RequestError(["object: no object is named"])
    return {"category": category, "description": description, "requester": "ros", "labels": [message.name]}
