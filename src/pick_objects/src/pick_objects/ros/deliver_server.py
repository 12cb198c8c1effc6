"""Action ``deliver``: missions for a running robot."""

import time
from typing import Callable, List, Optional

import rospy
from home_service_msgs.msg import DeliverAction, DeliverFeedback, DeliverGoal, DeliverResult, DeliveryState

from pick_objects.errand import Errand
from pick_objects.mission import Mission
from pick_objects.ros.mission_publisher import MissionPublisher, delivery_states
from planar import PlanarError
from planar.driving import FinishTask
from planar_ros.calls.actions import ActionServer

FEEDBACK_SECONDS = 0.2


class DeliverServer:
    """Executes goals one after the other; a new goal cancels the current one.

    Args:
        topics: Publisher of the mission's state, for the feedback.
        parse_goal: Converts a goal into a mission; raises PlanarError if it is not valid.
        carry_out: Carries a mission out, and calls its second argument with the errand at each step.
    """

    def __init__(
        self,
        topics: MissionPublisher,
        parse_goal: Callable[[DeliverGoal], Mission],
        carry_out: Callable[[Mission, Callable[[Errand], None]], FinishTask],
    ):
        self._topics, self._parse_goal, self._carry_out = topics, parse_goal, carry_out
        self._errand: Optional[Errand] = None
        self._latest_feedback = 0.0
        self._server = ActionServer("deliver", DeliverAction, auto_start=False)
        self._server.start()

    def serve(self, pause: Callable[[], None]) -> None:
        """Serve goals until shutdown; ``pause`` is called between two polls."""
        while not rospy.is_shutdown():
            if self._server.is_new_goal_available():
                self._do(self._server.accept_new_goal())
            pause()

    def _do(self, goal: DeliverGoal) -> None:
        start = rospy.Time.now()
        self._errand = None
        try:
            mission = self._parse_goal(goal)
        except PlanarError as error:
            rospy.logwarn("a mission is refused: %s", error)
            self._server.set_aborted(DeliverResult(reason=str(error)), str(error))
            return
        outcome = self._carry_out(mission, self._watch)
        if rospy.is_shutdown():  # the goal has then been aborted
            return
        states = self._states()
        result = DeliverResult(outcome.reason, states, rospy.Time.now() - start)
        if outcome.success:
            self._server.set_succeeded(result, outcome.reason)
        elif self._server.is_preempt_requested():
            self._server.set_preempted(result, outcome.reason)
        else:
            self._server.set_aborted(result, outcome.reason)

    def _states(self) -> List[DeliveryState]:
        return [] if self._errand is None else delivery_states(self._errand)

    def _watch(self, errand: Errand) -> None:
        self._errand = errand
        if self._server.is_preempt_requested():
            errand.cancel()
        if time.monotonic() - self._latest_feedback >= FEEDBACK_SECONDS:
            self._latest_feedback = time.monotonic()
            self._server.publish_feedback(DeliverFeedback(self._topics.message(errand)))
