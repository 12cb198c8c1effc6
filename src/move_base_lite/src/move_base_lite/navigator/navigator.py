"""Navigator: from goal, robot state and sensor data to velocity commands."""

from dataclasses import replace
from typing import Any, Optional, Sequence

import numpy as np

from move_base_lite.config import NavigatorSettings
from move_base_lite.costmap import LayeredCostmap, Maps, Observation
from move_base_lite.errors import PlanningError, PluginFailed
from move_base_lite.navigator.components import NavigatorComponents
from move_base_lite.navigator.decision import (
    CANCELLED_OUTCOME,
    SUCCEEDED_OUTCOME,
    SUCCESS_TEXT,
    Decision,
    GoalOutcome,
    RecoveryTrigger,
    Status,
    with_reason,
)
from move_base_lite.navigator.goal_execution import GoalExecution
from move_base_lite.navigator.inputs import NavigatorInputs, RobotState, accepts_separate_values
from move_base_lite.navigator.state_machine import GoalAborted, GoalSucceeded, step
from move_base_lite.navigator.zones import Zones
from move_base_lite.planning import Potential
from planar import Pose2, Twist2
from planar.deprecation import renamed_method
from planar.geometry.pose import check_pose


class Navigator:
    """Drives a differential-drive robot to one goal at a time without collisions.

    Call ``tick`` once a control period. The Navigator plans on the global costmap, follows the plan on
    the local costmap and runs the recovery behaviours in order when either fails, as move_base does
    (``state_machine.py``).

    Args:
        settings: Parameters of move_base, its costmaps, planners and recovery behaviours.
        grid: Static map, if there is one, or the maps of several static layers.
        zones: Keep-out and speed zones.
    """

    def __init__(self, settings: NavigatorSettings, grid: Maps = None, zones: Zones = Zones()):
        self._maps, self.zones = grid, zones
        self._components = NavigatorComponents(settings, grid, zones)
        self._new_goal: Optional[Pose2] = None
        self._execution: Optional[GoalExecution] = None

    @accepts_separate_values
    def tick(self, state: RobotState, inputs: NavigatorInputs = NavigatorInputs()) -> Decision:
        """Run one control period.

        Args:
            state: Time, poses and velocity of the robot.
            inputs: Sensor data since the last tick, and the latency of commands.

        Returns:
            Velocity command for the coming period, and state of the goal.
        """
        self._components.latency = inputs.latency
        decision = self._decide(state, inputs.observations)
        self._components.active_command = decision.command or Twist2()
        return decision

    def _decide(self, state: RobotState, observations: Sequence[Observation]) -> Decision:
        components, now = self._components, state.stamp
        try:
            if self.is_active or not self.settings.move_base.shutdown_costmaps:
                components.update_costmaps(state, observations)
            self._accept_goal(state)
            if self._execution is None:
                return Decision(Status.IDLE)
            distance = self.settings.move_base.oscillation_distance
            self._execution.update(state, distance, components.active_command, components.period)
            decision = step(self._execution, state, components)
        except GoalSucceeded:
            outcome = self._outcome(now, SUCCEEDED_OUTCOME, "SUCCESS", SUCCESS_TEXT)
            return self._end(Status.SUCCEEDED, SUCCESS_TEXT, outcome)
        except GoalAborted as end:
            text = with_reason(end.text, end.reason)
            outcome = self._outcome(now, end.reason.outcome, end.reason.code, text)
            return self._end(Status.ABORTED, text, outcome)
        except PluginFailed as failure:
            return self._abort_for_plugin(failure, now)
        remaining, nominal_speed = components.controller.distance_left, self.settings.controller.max_vel_x
        return replace(decision, progress=self._execution.progress(now, remaining, nominal_speed))

    def _accept_goal(self, state: RobotState) -> None:
        """Start the execution of a new goal, if there is one.

        Raises:
            GoalAborted: If the goal can never be reached.
        """
        goal, self._new_goal = self._new_goal, None
        if goal is not None:
            self._execution = GoalExecution.start(goal, state)
            try:
                self._components.costmaps.check_goal(goal)
            except PlanningError as error:
                raise GoalAborted(RecoveryTrigger.PLANNING.value, error) from error

    def set_goal(self, goal_in_map: Pose2) -> None:
        """Set the goal, from the next tick on; it preempts a goal in progress without stopping.

        Args:
            goal_in_map: Goal pose in the map frame.

        Raises:
            OutOfRangeError: The coordinates are too large.
        """
        check_pose(goal_in_map, "a goal")
        self._new_goal = goal_in_map

    def cancel(self, now: float) -> Decision:
        """Cancel the goal, if there is one.

        Args:
            now: Time [s].

        Returns:
            Decision that stops the robot.
        """
        if not self.is_active:
            return Decision(Status.IDLE)
        return self._end(Status.CANCELLED, "", self._outcome(now, CANCELLED_OUTCOME, "CANCELLED", ""))

    def clear_goal(self) -> None:
        """Drop the goal without an outcome; the caller has to stop the robot."""
        self._new_goal = self._execution = None
        self._components.reset_controller()

    def reset(self) -> None:
        """Drop the goal and all observations, as after a jump of time."""
        self._components.reset(self._maps)
        self.clear_goal()

    def set_map(self, grid: Maps) -> None:
        """Replace the static map; a costmap whose cells change drops its observations.

        Args:
            grid: Static map, or the maps of several static layers; None for none.
        """
        self._maps = grid
        self._components.costmaps.set_maps(grid)

    def update_settings(self, settings: NavigatorSettings) -> None:
        """Apply other settings; goal and plan stay.

        Args:
            settings: Parameters of move_base, its costmaps, planners and recovery behaviours.
        """
        self._components.update_settings(settings)

    def dynamic_obstacles_at(self, stamp: float) -> np.ndarray:
        """Predict the obstacles that are known to move.

        Args:
            stamp: Time of the prediction [s].

        Returns:
            Rows (N, 5) of x, y, vx, vy, radius in the odom frame [m, m/s].
        """
        return self._components.obstacle_tracker.obstacles_at(stamp)

    @property
    def settings(self) -> NavigatorSettings:
        """Settings in use."""
        return self._components.settings

    @property
    def is_active(self) -> bool:
        """Whether there is a goal."""
        return self._execution is not None or self._new_goal is not None

    @property
    def next_update(self) -> float:
        """Time at which a costmap is to be updated next [s]."""
        return self._components.costmaps.next_update

    @property
    def global_costmap(self) -> LayeredCostmap:
        """Costmap for planning, in the map frame."""
        return self._components.costmaps.global_costmap

    @property
    def local_costmap(self) -> LayeredCostmap:
        """Costmap for control, in the odometry frame."""
        return self._components.costmaps.local_costmap

    @property
    def potential(self) -> Optional[Potential]:
        """Potential of the latest plan, if visualize_potential or publish_potential is on."""
        return self._components.planner.potential

    def make_plan(self, start_in_map: Pose2, goal_in_map: Pose2, tolerance: float = 0.0) -> np.ndarray:
        """Plan a path between two poses without driving.

        Args:
            start_in_map: Start pose in the map frame; its heading does not matter.
            goal_in_map: Goal pose in the map frame; its heading does not matter.
            tolerance: Distance from the goal at which the path may end [m].

        Returns:
            Points of the path (N, 2), in the map frame [m].

        Raises:
            PlanningError: There is no path.
            OutOfRangeError: The coordinates are too large.
        """
        check_pose(start_in_map, "a start")
        check_pose(goal_in_map, "a goal")
        return self._components.plan(start_in_map, goal_in_map, tolerance)

    def clear_costmaps(self) -> None:
        """Clear all obstacles that are not in the static map (move_base: ~clear_costmaps)."""
        self._components.costmaps.clear()

    def clear_around(self, base_in_map: Pose2) -> None:
        """Clear the obstacles of the global costmap at the robot's position, within ``~clearing_radius``.

        Args:
            base_in_map: Robot pose in the map frame.
        """
        radius = self.settings.move_base.clearing_radius
        self.global_costmap.clear_around(
            base_in_map, 2.0 * (radius or self.global_costmap.footprint.circumscribed_radius)
        )

    def _abort_for_plugin(self, failure: PluginFailed, now: float) -> Decision:
        """Abort the goal, since the costs of a failed layer are unknown."""
        if not self.is_active:
            return Decision(Status.IDLE, text=str(failure))
        text = with_reason(RecoveryTrigger.CONTROLLING.value, failure)
        return self._end(Status.ABORTED, text, self._outcome(now, failure.outcome, failure.code, text))

    def _outcome(self, now: float, code: int, reason: str, text: str) -> GoalOutcome:
        if self._execution is None:
            return GoalOutcome(code, reason, text)
        return self._execution.outcome(now, code, reason, text)

    def _end(self, status: Status, text: str, outcome: GoalOutcome) -> Decision:
        self.clear_goal()
        return Decision(status, Twist2(), text, outcome=outcome)

    # Names of the first releases.
    change: Any = renamed_method("change", "update_settings")
    forget: Any = renamed_method("forget", "reset")
    forget_goal: Any = renamed_method("forget_goal", "clear_goal")
