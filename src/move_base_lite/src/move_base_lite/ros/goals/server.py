"""Goal server: move_base's action, and the topic move_base_simple/goal of rviz."""

from typing import Callable, Optional

import rospy
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseActionGoal, MoveBaseFeedback

from move_base_lite.navigator.decision import Status
from move_base_lite.ros.goals.messages import goal_from_msg
from move_base_lite.ros.topics.plan_messages import pose_msg
from planar import Pose2
from planar_ros.calls.actions import ActionServer
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.transforms import Transforms


class GoalServer:
    """Serves one goal at a time; a new goal preempts the old one.

    Args:
        map_frame: Frame of the map.
        transforms: Transforms from tf.
        on_cancel: Called without actionlib's locks when a client cancels the goal.
    """

    def __init__(self, map_frame: str, transforms: Transforms, on_cancel: Callable[[], None]):
        self._map_frame, self._transforms = map_frame, transforms
        self._server = ActionServer("move_base", MoveBaseAction, auto_start=False)
        self._server.register_preempt_callback(lambda: LockstepClient.of_node().defer(on_cancel))
        self._current_goal = rospy.Publisher("~current_goal", PoseStamped, queue_size=1)
        self._action_goal = rospy.Publisher("move_base/goal", MoveBaseActionGoal, queue_size=1)
        rospy.Subscriber("move_base_simple/goal", PoseStamped, self._on_simple_goal, queue_size=1)

    def start(self) -> None:
        """Start the action server."""
        self._server.start()

    @property
    def is_active(self) -> bool:
        """Whether there is a goal."""
        return self._server.is_active()

    @property
    def is_cancelled(self) -> bool:
        """Whether the goal is cancelled and no other goal follows it."""
        server = self._server
        return server.is_active() and server.is_preempt_requested() and not server.is_new_goal_available()

    def accept_goal(self, now: rospy.Time) -> Optional[Pose2]:
        """Accept a new goal, which preempts the old one.

        Args:
            now: Stamp of the published goal.

        Returns:
            Goal pose in the map frame; None if there is no new goal.

        Raises:
            NavigationError: The goal is invalid; the action goal is accepted and has to be aborted.
        """
        with self._server.action_server.lock, self._server.lock:
            if not self._server.is_new_goal_available():
                return None
            message = self._server.accept_new_goal().target_pose
        goal = goal_from_msg(message, self._map_frame, self._transforms)
        self._current_goal.publish(pose_msg(goal, now, self._map_frame))
        return goal

    def publish_feedback(self, base_in_map: Pose2, now: rospy.Time) -> None:
        """Publish the robot's pose as feedback.

        Args:
            base_in_map: Robot pose in the map frame.
            now: Stamp of the message.
        """
        if self._server.is_active():
            self._server.publish_feedback(MoveBaseFeedback(pose_msg(base_in_map, now, self._map_frame)))

    def finish(self, status: Status, text: str) -> None:
        """Report the result of the goal.

        Args:
            status: Final status; all but SUCCEEDED and CANCELLED abort the goal.
            text: Text of the action's result.
        """
        if status is Status.SUCCEEDED:
            self._server.set_succeeded(text=text)
        elif status is Status.CANCELLED:
            self._server.set_preempted()
        else:
            self._server.set_aborted(text=text)

    def abort(self, text: str) -> bool:
        """Abort the goal, also one that was not accepted yet.

        Args:
            text: Text of the action's result.

        Returns:
            Whether there was a goal.
        """
        with self._server.action_server.lock, self._server.lock:
            if self._server.is_new_goal_available():
                self._server.accept_new_goal()
            was_active = self._server.is_active()
            if was_active:
                self._server.set_aborted(text=text)
        return bool(was_active)

    def _on_simple_goal(self, message):
        goal = MoveBaseActionGoal()
        goal.header.stamp = rospy.Time.now()
        goal.goal.target_pose = message
        self._action_goal.publish(goal)
