"""Who works for the Navigator: a planner, a controller, costmaps, and an eye on what moves."""

from typing import Optional, Sequence, Tuple

import numpy as np

from move_base_lite.config import NavigatorSettings
from move_base_lite.control import LOCAL_PLANNERS, ControlContext, Controller
from move_base_lite.costmap import Observation
from move_base_lite.dynamic_obstacles import DynamicObstacleTracker
from move_base_lite.navigator.costmaps import Costmaps
from move_base_lite.navigator.goal_execution import RobotState
from move_base_lite.navigator.motion_prediction import predict_motion
from move_base_lite.navigator.zones import Zones
from move_base_lite.planning import GLOBAL_PLANNERS
from planar import OccupancyGrid, Pose2, Twist2


class NavigatorComponents:
    """Made from settings, and changed with them; ``zones`` may be switched by others.

    ``latency``: seconds until a command takes effect; ``in_force``: the one that the robot obeys meanwhile.
    """

    def __init__(self, settings: NavigatorSettings, grid: Optional[OccupancyGrid], zones: Zones):
        self.settings, self.zones = settings, zones
        self.latency, self.active_command = 0.0, Twist2()
        self.planner = GLOBAL_PLANNERS.make(settings.planner)
        self.set_map(grid)
        self.reset_controller()

    def set_map(self, grid: Optional[OccupancyGrid]) -> None:
        """Another map, and nothing has been seen yet."""
        self.costmaps = Costmaps(self.settings, grid, self.zones)
        self._obstacle_tracker = DynamicObstacleTracker()

    def reset_controller(self) -> None:
        """Forgets how the last goal was pursued."""
        settings = self.settings.controller
        self.controller = Controller(settings, self.period, LOCAL_PLANNERS.make(settings, self.period))

    def update_settings(self, settings: NavigatorSettings) -> None:
        """Goes on with other settings, plan included."""
        before, self.settings = (self.settings.controller, self.period), settings
        self.planner = GLOBAL_PLANNERS.make(settings.planner)
        if (settings.controller, self.period) != before:
            planner = LOCAL_PLANNERS.make(settings.controller, self.period)
            self.controller.change(settings.controller, self.period, planner)
        self.costmaps.update_settings(settings)

    @property
    def period(self) -> float:
        """Of control, seconds."""
        return 1.0 / self.settings.move_base.controller_frequency

    def update_costmaps(self, state: RobotState, observations: Sequence[Observation]) -> None:
        """Takes in what is seen; a plan does not have to lead around people who walk."""
        lasting = [self._lasting(state.base_in_odom, observation) for observation in observations]
        self.costmaps.update(state.now, state.base_in_map, state.base_in_odom, observations, lasting)

    def _lasting(self, base_in_odom: Pose2, observation: Observation) -> Observation:
        """What is seen without what moves."""
        settings = self.settings.controller.tracker_settings
        if settings is None or observation.topic != self.settings.scan_topic:
            return observation
        return self._obstacle_tracker.update(base_in_odom, observation, settings)

    def plan(self, start_in_map: Pose2, goal_in_map: Pose2, tolerance: float = 0.0) -> np.ndarray:
        """Path (N, 2) in the map between any two places. Raises PlanningError."""
        costmap = self.costmaps.global_costmap
        start_xy: Tuple[float, float] = (start_in_map.x, start_in_map.y)
        return self.planner.plan(
            costmap.costs, costmap.window, start_xy, (goal_in_map.x, goal_in_map.y), tolerance
        )

    def control_context(self, state: RobotState) -> ControlContext:
        """What a velocity is to be chosen from: how things will stand when it takes effect."""
        controller = self.settings.controller
        acceleration = Twist2(controller.acc_lim_x, controller.acc_lim_theta)
        moved, twist = predict_motion(state.twist, self.active_command, self.latency, acceleration)
        return ControlContext(
            state.base_in_map @ moved,
            state.base_in_odom @ moved,
            twist,
            self.costmaps.local_costmap,
            self._obstacle_tracker.obstacles_at(state.now + self.latency),
            self.costmaps.global_costmap,
        )
