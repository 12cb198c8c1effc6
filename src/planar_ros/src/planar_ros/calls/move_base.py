"""Client of move_base with goals and plans as planar types."""

import math
import time
from typing import Any, Optional

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseFeedback, MoveBaseGoal
from nav_msgs.srv import GetPlan, GetPlanRequest

from planar import Pose2
from planar.driving import DriveOutcome
from planar_ros.calls.actions import goal_is_lost, goal_is_over, server_connection, server_is_ready
from planar_ros.calls.services import call_service
from planar_ros.messages.conversion import pose2_from_msg, pose2_to_msg
from planar_ros.node.topics import flush_and_close

# Wall-clock time to wait for a plan [s].
PLAN_SECONDS = 5.0
POLL_SECONDS = 0.02


class MoveBaseClient:
    """Sends goals to move_base, one at a time.

    Args:
        frame_id: Frame of goals and plans.

    Attributes:
        robot: Robot pose in move_base's global frame from the latest feedback; None before the first.
    """

    def __init__(self, frame_id: str = "map"):
        self.robot: Optional[Pose2] = None
        self._frame_id = frame_id
        self._is_driving = False
        self._sent_to: Any = None
        self._lost_since: Optional[float] = None
        self._client = actionlib.SimpleActionClient("move_base", MoveBaseAction)

    @property
    def name(self) -> str:
        """Name for messages to people: "the action /move_base"."""
        return f"the action {rospy.resolve_name('move_base')}"

    def is_ready(self) -> bool:
        """Whether move_base is connected in both directions."""
        return server_is_ready(self._client)

    def send(self, goal: Pose2, stamp: Optional[rospy.Time] = None) -> None:
        """Send a goal, which replaces any earlier one.

        Args:
            goal: Target pose in ``frame_id``.
            stamp: Stamp of the goal; None for now.
        """
        message = MoveBaseGoal(target_pose=self._stamped(goal))
        message.target_pose.header.stamp = rospy.Time.now() if stamp is None else stamp
        self._sent_to = server_connection(self._client)
        self._client.send_goal(message, feedback_cb=self._on_feedback)
        self._is_driving, self._lost_since = True, None

    def outcome(self) -> Optional[DriveOutcome]:
        """Return the outcome of the last goal once; None while it is active and afterwards."""
        if not self._is_driving:
            return None
        is_lost = goal_is_lost(self._client, self._sent_to)
        if not (is_lost or goal_is_over(self._client)):
            return None
        self._is_driving = False
        status = "LOST" if is_lost else GoalStatus.to_string(self._client.get_state())
        if status == "LOST":  # the status text is older than the restart
            return DriveOutcome(status, f"{self.name} has restarted and no longer knows the goal")
        return DriveOutcome(status, self._client.get_goal_status_text())

    def is_lost(self, patience: float) -> bool:
        """Whether move_base has been gone for ``patience`` wall-clock seconds; call this periodically."""
        now = time.monotonic()
        if self.is_ready():
            self._lost_since = None
        elif self._lost_since is None:
            self._lost_since = now
        return self._lost_since is not None and now - self._lost_since > patience

    def cancel(self) -> None:
        """Cancel the goal if it is active."""
        if self._is_driving and not goal_is_over(self._client):
            self._client.cancel_goal()
        self._is_driving = False

    @property
    def is_idle(self) -> bool:
        """Whether no goal is active."""
        return goal_is_over(self._client)

    def stop(self, patience: float) -> None:
        """Cancel the goal and wait at most ``patience`` wall-clock seconds until it has ended."""
        self.cancel()
        deadline = time.monotonic() + patience
        while not goal_is_over(self._client) and time.monotonic() < deadline:
            time.sleep(POLL_SECONDS)

    def cancel_all(self) -> None:
        """Cancel all goals, including those of other clients."""
        self._is_driving = False
        self._client.cancel_all_goals()

    def cancel_on_shutdown(self) -> None:
        """Cancel the goal on shutdown, and wait until move_base has received the request."""

        def cancel() -> None:
            inner = self._client.action_client
            flush_and_close(inner.pub_goal)  # so that no goal arrives after its cancel request
            self.cancel()
            flush_and_close(inner.pub_cancel)

        rospy.on_shutdown(cancel)

    def plan_length(self, start: Optional[Pose2], end: Pose2) -> Optional[float]:
        """Return the length of move_base's plan between two poses.

        Args:
            start: Start pose in ``frame_id``; None for the robot's pose.
            end: Target pose in ``frame_id``.

        Returns:
            Path length [m]; None if there is no plan.

        Raises:
            ServiceError: If move_base does not answer.
        """
        request = GetPlanRequest(goal=self._stamped(end))
        if start is not None:
            request.start = self._stamped(start)
        points = call_service("move_base/make_plan", GetPlan, request, PLAN_SECONDS).plan.poses
        if not points:
            return None
        corners = [(point.pose.position.x, point.pose.position.y) for point in points]
        return sum(math.dist(a, b) for a, b in zip(corners, corners[1:]))

    def _stamped(self, pose: Pose2) -> PoseStamped:
        message = PoseStamped(pose=pose2_to_msg(pose))
        message.header.frame_id = self._frame_id
        return message

    def _on_feedback(self, feedback: MoveBaseFeedback) -> None:
        self.robot = pose2_from_msg(feedback.base_position.pose)
