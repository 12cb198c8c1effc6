"""Orders become goals and plans of move_base, what comes of them becomes events."""

import math
from typing import Optional, Union

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.srv import GetPlan, GetPlanRequest

from pick_objects.approach import GoTo
from pick_objects.errand import MeasureWays, WaysMeasured
from planar import Pose2
from planar.driving import GoalReached, GoalRefused
from planar_ros.calls.actions import goal_is_over, server_is_ready
from planar_ros.calls.services import ServiceError, call_service
from planar_ros.messages.conversion import pose2_from_msg, pose2_to_msg

PLAN_SECONDS = 5.0


class Driver:
    """Has move_base drive, one goal at a time."""

    def __init__(self, frame_id: str):
        self.robot_in_map = Pose2()
        self._frame_id = frame_id
        self._order: Optional[GoTo] = None
        self._client = actionlib.SimpleActionClient("move_base", MoveBaseAction)

    def is_ready(self) -> bool:
        return server_is_ready(self._client)

    def send(self, order: GoTo) -> None:
        goal = MoveBaseGoal(target_pose=self._stamped(order.pose))
        goal.target_pose.header.stamp = rospy.Time.now()
        if order.attempt > 1:
            place, pose = order.place.name, order.pose
            rospy.logwarn("place %s: attempt %d, at (%g, %g)", place, order.attempt, pose.x, pose.y)
        self._order = order
        self._client.send_goal(goal, feedback_cb=self._keep_position)

    def event(self) -> Union[None, GoalReached, GoalRefused]:
        """What came of the last goal, told once; None while it is pursued."""
        if self._order is None or not goal_is_over(self._client):
            return None
        order, self._order = self._order, None
        status = self._client.get_state()
        if status == GoalStatus.SUCCEEDED:
            return GoalReached()
        text = self._client.get_goal_status_text() or GoalStatus.to_string(status)
        rospy.logwarn("place %s: %s", order.place.name, text)
        return GoalRefused(text)

    def stop(self) -> None:
        self._order = None
        self._client.cancel_all_goals()

    def measure(self, order: MeasureWays) -> WaysMeasured:
        """The lengths of move_base's plans; straight lines if it makes no plans."""
        try:
            return WaysMeasured(tuple(self._length(start, end) for start, end in order.ways))
        except ServiceError as error:
            rospy.logwarn("the order of the deliveries goes by straight lines: %s", error)
            lines = ((start or self.robot_in_map).distance_to(end) for start, end in order.ways)
            return WaysMeasured(tuple(lines))

    def _length(self, start: Optional[Pose2], end: Pose2) -> Optional[float]:
        request = GetPlanRequest(goal=self._stamped(end))
        if start is not None:  # else it plans from where the robot is
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

    def _keep_position(self, feedback) -> None:
        self.robot_in_map = pose2_from_msg(feedback.base_position.pose)
