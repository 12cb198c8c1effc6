"""Listens to the goals that move_base is given by hand, and to how they end."""

from typing import Any, Callable, Dict, Optional

from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseActionGoal, MoveBaseActionResult

from home_service.judging.goal_log import GoalLog
from home_service.ros.hearing import hear
from planar import Pose2
from planar_ros.messages.conversion import pose2_from_msg


class GoalWatch:
    """``say``: is called with each line; ``truth``: tells where the robot truly is, in the map."""

    def __init__(self, say: Callable[[str], None], truth: Callable[[], Optional[Pose2]]):
        self._say, self._truth = say, truth
        self._log = GoalLog()

    def start(self) -> None:
        hear("move_base/goal", MoveBaseActionGoal, self._see_goal)
        hear("move_base/result", MoveBaseActionResult, self._see_result)

    def findings(self) -> Dict[str, Any]:
        return self._log.findings()

    def _see_goal(self, message):
        target = message.goal.target_pose
        self._tell(self._log.sent(message.goal_id.id, target.header.frame_id, pose2_from_msg(target.pose)))

    def _see_result(self, message):
        status = message.status
        has_reached = status.status == GoalStatus.SUCCEEDED
        self._tell(self._log.ended(status.goal_id.id, has_reached, status.text, self._truth()))

    def _tell(self, line: Optional[str]) -> None:
        if line is not None:
            self._say(line)
