"""Components of the Navigator: global planner, controller, costmaps and the tracker of moving obstacles."""

from dataclasses import replace
from typing import Any, Mapping, Sequence, Tuple

import numpy as np

from move_base_lite.config import NavigatorSettings
from move_base_lite.control import (
    LOCAL_PLANNERS,
    ControlContext,
    Controller,
    ControllerSettings,
    LocalPlanner,
)
from move_base_lite.costmap import Maps, Observation
from move_base_lite.dynamic_obstacles import DynamicObstacleTracker
from move_base_lite.navigator.costmaps import Costmaps
from move_base_lite.navigator.inputs import RobotState
from move_base_lite.navigator.motion_prediction import predict_motion
from move_base_lite.navigator.zones import Zones
from move_base_lite.planning import GLOBAL_PLANNERS, PlanRequest
from planar import Pose2, Twist2

# Height up to which the ends of a tilted laser's beams may be on the floor [m].
FLOOR_HEIGHT = 0.1


class NavigatorComponents:
    """The components that one Navigator uses, built from its settings.

    Attributes:
        settings: Settings in use.
        zones: Keep-out and speed zones; a service may switch them at any time.
        latency: Time until a command takes effect [s].
        active_command: Velocity command that the robot follows until then.
        planner: Global planner.
        controller: Follows the plan with the local planner.
        costmaps: Global and local costmap.
    """

    def __init__(self, settings: NavigatorSettings, maps: Maps, zones: Zones):
        """Construct the components.

        Args:
            settings: Settings of the Navigator.
            maps: Maps of the static layers.
            zones: Keep-out and speed zones.
        """
        self.settings, self.zones = settings, zones
        self.latency, self.active_command = 0.0, Twist2()
        self.planner = GLOBAL_PLANNERS.make(settings.planner)
        self.reset(maps)
        self.reset_controller()

    def reset(self, maps: Maps) -> None:
        """Drop all observations.

        Args:
            maps: Maps of the static layers.
        """
        self.costmaps = Costmaps(self.settings, maps, self.zones)
        self.obstacle_tracker = DynamicObstacleTracker()

    def reset_controller(self) -> None:
        """Replace the controller, which keeps state of the goal."""
        self.controller = Controller(*self._control())

    def update_settings(self, settings: NavigatorSettings) -> None:
        """Apply other settings; the plan in use stays."""
        before, self.settings = self._control_settings, settings
        self.planner = GLOBAL_PLANNERS.make(settings.planner)
        if self._control_settings != before:
            self.controller.change(*self._control())
        self.costmaps.update_settings(settings)

    @property
    def _control_settings(self) -> Tuple[ControllerSettings, float, Mapping[str, Any]]:
        return self.settings.controller, self.period, self.settings.extensions

    def _control(self) -> Tuple[ControllerSettings, float, LocalPlanner, Mapping[str, Any]]:
        """Arguments of the Controller, with a new local planner."""
        settings, period, extensions = self._control_settings
        return settings, period, LOCAL_PLANNERS.make(settings, period), extensions

    @property
    def period(self) -> float:
        """Control period [s]."""
        return 1.0 / self.settings.move_base.controller_frequency

    def update_costmaps(self, state: RobotState, observations: Sequence[Observation]) -> None:
        """Update both costmaps; observations of moving obstacles are added to the local one only.

        Args:
            state: Robot state at this control tick.
            observations: Sensor data since the last tick.
        """
        static = [self._without_moving(state.base_in_odom, observation) for observation in observations]
        self.costmaps.update(state, observations, static)

    def _without_moving(self, base_in_odom: Pose2, observation: Observation) -> Observation:
        """Track moving obstacles in a scan and remove their beams."""
        settings = self.settings.controller.tracker_settings
        if settings is None or observation.topic != self.settings.scan_topic:
            return observation
        if np.ndim(observation.heights) == 0:
            return self.obstacle_tracker.update(base_in_odom, observation, settings)
        # The ends of a tilted laser's beams on the floor move with the robot.
        above_floor = np.where(observation.heights > FLOOR_HEIGHT, observation.ranges, np.nan)
        static = self.obstacle_tracker.update(
            base_in_odom, replace(observation, ranges=above_floor), settings
        )
        is_moving = np.isnan(static.ranges) & ~np.isnan(above_floor)
        return replace(observation, ranges=np.where(is_moving, np.nan, observation.ranges))

    def plan(self, start_in_map: Pose2, goal_in_map: Pose2, tolerance: float = 0.0) -> np.ndarray:
        """Plan a path between two poses in the map.

        Args:
            start_in_map: Start; its heading does not matter.
            goal_in_map: Goal; its heading does not matter.
            tolerance: Distance from the goal at which the path may end [m].

        Returns:
            Points of the path (N, 2), in the map frame [m].

        Raises:
            PlanningError: There is no path.
        """
        costmap = self.costmaps.global_costmap
        start_xy: Tuple[float, float] = (start_in_map.x, start_in_map.y)
        goal_xy = (goal_in_map.x, goal_in_map.y)
        return self.planner.plan(PlanRequest(costmap.costs, costmap.window, start_xy, goal_xy, tolerance))

    def control_context(self, state: RobotState) -> ControlContext:
        """Predict the inputs of the local planner for the time at which its command takes effect.

        Args:
            state: Robot state at this control tick.
        """
        controller = self.settings.controller
        acceleration = Twist2(controller.acc_lim_x, controller.acc_lim_theta)
        moved, twist = predict_motion(state.twist, self.active_command, self.latency, acceleration)
        return ControlContext(
            state.base_in_map @ moved,
            state.base_in_odom @ moved,
            twist,
            self.costmaps.local_costmap,
            self.obstacle_tracker.obstacles_at(state.stamp + self.latency),
            self.costmaps.global_costmap,
        )
