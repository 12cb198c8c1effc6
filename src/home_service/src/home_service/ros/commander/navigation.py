"""Commands that are executed by move_base."""

import math
from typing import List, Optional, Sequence

import rospy

from home_service.ros.commander.outcomes import Feedback, Outcome, Result
from home_service.ros.commander.task import PATIENCE_SECONDS, CommanderTask
from planar import Pose2
from planar.driving import DriveResult
from planar_ros.calls.move_base import MoveBaseClient

# Result and default reason for each outcome of move_base.
RESULTS = {
    DriveResult.REACHED: (Result.SUCCEEDED, "goal reached"),
    DriveResult.PREEMPTED: (Result.CANCELLED, "another goal took its place"),
}


class GoalTask(CommanderTask):
    """Drives to a goal."""

    def __init__(self, move_base: MoveBaseClient, goal: Pose2, timeout: float):
        super().__init__(timeout)
        self.goal = goal
        self._move_base = move_base
        self._pose_before = move_base.robot

    def run(self) -> Outcome:
        if not all(map(math.isfinite, (self.goal.x, self.goal.y, self.goal.yaw))):
            return Outcome(Result.FAILED, f"the goal {self.goal} is not finite")
        self._pose_before = self._move_base.robot
        self._move_base.send(self.goal)
        outcome = self._wait(self._poll)
        self._move_base.cancel()
        return outcome

    def feedback(self) -> Feedback:
        pose = self._move_base.robot
        if pose is None or pose is self._pose_before:
            return Feedback(self._seconds, None)
        return Feedback(self._seconds, pose.distance_to(self.goal), pose)

    def _poll(self) -> Optional[Outcome]:
        ended = self._move_base.outcome()
        if ended is not None:
            result, reason = RESULTS.get(ended.result, (Result.FAILED, ended.status.lower()))
            return Outcome(result, ended.text or reason)
        if self._move_base.is_lost(PATIENCE_SECONDS):
            return Outcome(Result.FAILED, f"{self._move_base.name} does not respond any more")
        return None


class WaypointsTask(CommanderTask):
    """Drives to goals one after the other."""

    def __init__(self, drives: Sequence[GoalTask], stop_on_failure: bool):
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
