"""Subscriber of the goals that are sent to move_base by hand, and of their outcomes."""

from typing import Any, Callable, Dict, Optional

from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseActionGoal, MoveBaseActionResult

from evaluation.goal_log import GoalLog
from evaluation.ros.subscriptions import subscribe
from planar import Pose2
from planar_ros.messages.conversion import pose2_from_msg


class GoalMonitor:
    """Logs goals and outcomes.

    Args:
        log: Called with each line.
        truth: Returns the true pose of the robot in the map.
    """

    def __init__(self, log: Callable[[str], None], truth: Callable[[], Optional[Pose2]]):
        self._log, self._truth = log, truth
        self._goals = GoalLog()

    def start(self) -> None:
        subscribe("move_base/goal", MoveBaseActionGoal, self._on_goal)
        subscribe("move_base/result", MoveBaseActionResult, self._on_result)

    def result_fields(self) -> Dict[str, Any]:
        return self._goals.result_fields()

    def _on_goal(self, message):
        target = message.goal.target_pose
        self._log_line(
            self._goals.add(message.goal_id.id, target.header.frame_id, pose2_from_msg(target.pose))
        )

    def _on_result(self, message):
        status = message.status
        has_reached = status.status == GoalStatus.SUCCEEDED
        self._log_line(self._goals.end(status.goal_id.id, has_reached, status.text, self._truth()))

    def _log_line(self, line: Optional[str]) -> None:
        if line is not None:
            self._log(line)
