"""Drives by move_base, one or several."""

import math
import time
from typing import List, Optional, Sequence

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseGoal

from home_service.ros.commander.outcomes import Feedback, Outcome, Result
from home_service.ros.commander.task import PATIENCE_SECONDS, Task
from planar import Pose2
from planar_ros.calls.actions import goal_is_over, server_is_ready
from planar_ros.messages.conversion import pose2_from_msg, pose2_to_msg


class Drive(Task):
    """A goal for move_base."""

    def __init__(self, client: actionlib.SimpleActionClient, frame_id: str, goal: Pose2, timeout: float):
        super().__init__(timeout)
        self.goal = goal
        self._client, self._frame_id = client, frame_id
        self._pose: Optional[Pose2] = None
        self._lost_since: Optional[float] = None

    def run(self) -> Outcome:
        if not all(map(math.isfinite, (self.goal.x, self.goal.y, self.goal.yaw))):
            return Outcome(Result.FAILED, f"the goal ({self.goal.x}, {self.goal.y}) is not a pose")
        message = MoveBaseGoal()
        message.target_pose.header.frame_id = self._frame_id
        message.target_pose.header.stamp = rospy.Time.now()
        message.target_pose.pose = pose2_to_msg(self.goal)
        self._client.send_goal(message, feedback_cb=self._keep_pose)
        outcome = self._wait(self._look)
        if not goal_is_over(self._client):
            self._client.cancel_goal()
        return outcome

    def feedback(self) -> Feedback:
        left = None if self._pose is None else self._pose.distance_to(self.goal)
        return Feedback(self._seconds, left, self._pose)

    def _look(self) -> Optional[Outcome]:
        if not goal_is_over(self._client):
            return self._notice_loss()
        state = self._client.get_state()
        text = self._client.get_goal_status_text()
        if state == GoalStatus.SUCCEEDED:
            return Outcome(Result.SUCCEEDED, text or "goal reached")
        if state in (GoalStatus.PREEMPTED, GoalStatus.RECALLED):
            return Outcome(Result.CANCELLED, text or "another goal took its place")
        return Outcome(Result.FAILED, text or GoalStatus.to_string(state).lower())

    def _notice_loss(self) -> Optional[Outcome]:
        if server_is_ready(self._client):
            self._lost_since = None
        elif self._lost_since is None:
            self._lost_since = time.monotonic()
        elif time.monotonic() - self._lost_since > PATIENCE_SECONDS:
            return Outcome(Result.FAILED, f"the action {rospy.resolve_name('move_base')} is gone")
        return None

    def _keep_pose(self, feedback) -> None:
        self._pose = pose2_from_msg(feedback.base_position.pose)


class Waypoints(Task):
    """Drives one after the other."""

    def __init__(self, drives: Sequence[Drive], stop_on_failure: bool):
        super().__init__(math.inf)
        self._drives, self._stop_on_failure = drives, stop_on_failure
        self._number = 0
        self._start = rospy.get_time()

    def run(self) -> Outcome:
        missed: List[int] = []
        reason = ""
        for number, drive in enumerate(self._drives):
            self._number = number
            if self._is_cancelled.is_set():
                drive.cancel()
            outcome = drive.run()
            if outcome.success:
                continue
            missed.append(self._number)
            reason = reason or f"waypoint {self._number}: {outcome.reason}"
            if outcome.result is Result.CANCELLED or self._stop_on_failure:
                missed.extend(range(self._number + 1, len(self._drives)))
                return Outcome(outcome.result, reason, tuple(missed))
        count = len(self._drives)
        if missed:
            text = f"{count - len(missed)} of {count} waypoints reached; {reason}"
            return Outcome(Result.FAILED, text, tuple(missed))
        return Outcome(Result.SUCCEEDED, f"{count} waypoints reached")

    def cancel(self) -> None:
        super().cancel()
        self._drives[self._number].cancel()

    def feedback(self) -> Feedback:
        current = self._drives[self._number].feedback()
        return Feedback(self._seconds, current.left, current.pose, self._number)
