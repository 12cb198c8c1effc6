"""Services make_plan and clear_costmaps."""

import threading
from typing import Callable, Optional

import numpy as np
import rospy
from nav_msgs.srv import GetPlan, GetPlanResponse
from std_srvs.srv import Empty, EmptyResponse

from move_base_lite.config import NavigatorSettings
from move_base_lite.errors import NavigationError
from move_base_lite.navigator import Navigator
from move_base_lite.ros.goals.messages import goal_from_msg
from move_base_lite.ros.topics.plan_messages import plan_msg
from planar import Pose2
from planar_ros.messages.conversion import frame_name
from planar_ros.messages.transforms import Transforms

INACTIVE_TEXT = "move_base must be in an inactive state to make a plan for an external user"
NO_START_TEXT = "move_base cannot make a plan for you because it could not get the start pose of the robot"


class PlanServices:
    """Serves ``~make_plan``, ``~<planner>/make_plan`` and ``~clear_costmaps``.

    Args:
        navigator: The Navigator.
        lock: Guards the Navigator.
        transforms: Transforms from tf.
        is_active: Whether there is a goal.
        robot_in_map: Returns the robot's pose, None if it is unknown.
        global_planner: Name of the global planner, for its service.
    """

    def __init__(
        self,
        navigator: Navigator,
        lock: threading.RLock,
        transforms: Transforms,
        is_active: Callable[[], bool],
        robot_in_map: Callable[[], Optional[Pose2]],
        global_planner: str,
    ):
        self._navigator, self._lock, self._transforms = navigator, lock, transforms
        self._is_active, self._robot_in_map = is_active, robot_in_map
        rospy.Service("~make_plan", GetPlan, self._on_make_plan)
        rospy.Service(f"~{global_planner}/make_plan", GetPlan, self._on_planner_make_plan)
        rospy.Service("~clear_costmaps", Empty, self._on_clear_costmaps)

    @property
    def _settings(self) -> NavigatorSettings:
        return self._navigator.settings

    def _on_make_plan(self, request):
        with self._lock:
            if self._is_active():
                raise rospy.ServiceException(INACTIVE_TEXT)
            settings, base_in_map = self._settings.move_base, self._robot_in_map()
            if settings.make_plan_clear_costmap and base_in_map is not None:
                self._navigator.clear_around(base_in_map)
            return self._plan(request, request.tolerance, settings.make_plan_add_unreachable_goal)

    def _on_planner_make_plan(self, request):
        with self._lock:
            return self._plan(request, 0.0, False)

    def _plan(self, request, tolerance: float, adds_goal: bool) -> GetPlanResponse:
        map_frame = frame_name(self._settings.global_costmap.global_frame)
        response = GetPlanResponse()
        try:
            start = self._robot_in_map()
            if request.start.header.frame_id:
                start = goal_from_msg(request.start, map_frame, self._transforms)
            if start is None:
                raise rospy.ServiceException(NO_START_TEXT)
            goal = goal_from_msg(request.goal, map_frame, self._transforms)
            path_xy = self._navigator.make_plan(start, goal, tolerance)
        except NavigationError as error:
            rospy.logwarn("make_plan: %s", error)
            return response
        goal_xy = np.array([[goal.x, goal.y]])
        if adds_goal and not np.allclose(path_xy[-1], goal_xy):
            path_xy = np.concatenate((path_xy, goal_xy))
        mode = self._settings.planner.orientation_mode
        plan = plan_msg(path_xy, rospy.Time.now(), map_frame, mode, start.yaw, goal.yaw)
        response.plan.poses = plan.poses
        return response

    def _on_clear_costmaps(self, request):
        with self._lock:
            self._navigator.clear_costmaps()
        return EmptyResponse()
