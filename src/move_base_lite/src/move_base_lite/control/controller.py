"""The Controller: follows a plan with a local planner, and does what is the same for all local planners."""

import math
from dataclasses import dataclass, replace
from typing import Any, Mapping, Optional

import numpy as np

from move_base_lite.control.escape import escape_command
from move_base_lite.control.local_planner import ControlContext, LocalPlanner, Plan, TrajectorySamples
from move_base_lite.control.path_progress import PathProgress
from move_base_lite.control.rotation import blocks_dynamic_obstacle, stopping_command, turn_in_place
from move_base_lite.control.settings import ControllerSettings
from move_base_lite.costmap import LayeredCostmap
from move_base_lite.errors import ControlError, ControlPluginFailed
from planar import Pose2, Twist2, wrap
from planar.extensions import SelectedPlugins

# Heading error at which a turn in place towards the plan ends [rad].
ALIGNED_ANGLE = 0.3
# Heading error above which the robot turns in place if the local planner fails [rad].
HEADING_TOLERANCE = 0.1
# Share of the acceleration limit used to slow down towards the plan's end.
APPROACH_DECELERATION_SHARE = 0.3
# Distance beyond xy_goal_tolerance that a robot may drift while it stops and turns at the goal [m]; farther
# away it was moved, or localization jumped, and the goal position is no longer latched.
LATCH_MARGIN = 0.1
# Arrivals after which the goal position stays latched: a pose estimate that shifts as the robot turns would
# otherwise make it leave and return forever.
MAX_ARRIVALS = 3


@dataclass(frozen=True, eq=False)
class ControlOutput:
    """The result of a control period.

    Attributes:
        command: Velocity command [m/s, rad/s].
        poses: (N, 3) predicted trajectory: x, y, yaw in the local frame.
        path_xy: (M, 2) part of the plan that is followed, in the local frame.
        trajectory_samples: The trajectories that the local planner evaluated, also if none was valid; None if
            the planner was not called or does not show them.
    """

    command: Twist2
    poses: np.ndarray
    path_xy: np.ndarray
    trajectory_samples: Optional[TrajectorySamples] = None


class Controller:
    """Follows one plan at a time with a local planner.

    Plan and goal are in the map frame, costs in the local frame. The controller itself turns in place towards
    the plan (as Nav2's rotation shim controller), stops and turns at the goal, and backs out of collisions.

    Args:
        settings: Settings of the local planner.
        period: Control period [s].
        planner: Local planner constructed with these settings and this period.
        extensions: Settings of further plugins, by the parameter that selects them.
    """

    def __init__(
        self,
        settings: ControllerSettings,
        period: float,
        planner: LocalPlanner,
        extensions: Mapping[str, Any] = {},
    ):
        self.change(settings, period, planner, extensions)
        self._progress: Optional[PathProgress] = None
        self._goal_in_map = Pose2()
        self._arrived = False
        self._arrivals = 0
        self._is_turning = False
        self._commanded_omega: Optional[float] = None

    def change(
        self,
        settings: ControllerSettings,
        period: float,
        planner: LocalPlanner,
        extensions: Mapping[str, Any] = {},
    ) -> None:
        """Replace settings and plugins; the plan stays.

        Args:
            settings: Settings of the local planner.
            period: Control period [s].
            planner: Local planner constructed with these settings and this period.
            extensions: Settings of further plugins, by the parameter that selects them.
        """
        self._settings, self._period, self._planner = settings, period, planner
        self._plugins = SelectedPlugins(extensions)

    def set_plan(self, path_xy: np.ndarray, goal_in_map: Pose2) -> None:
        """Follow another path; a different goal resets the arrival state.

        Args:
            path_xy: (N, 2), in the map frame [m].
            goal_in_map: Goal pose in the map frame.
        """
        self._progress = PathProgress(path_xy)
        if goal_in_map != self._goal_in_map:
            self._goal_in_map = goal_in_map
            self._arrived = self._is_turning = False
            self._arrivals = 0

    def is_goal_reached(self, base_in_map: Pose2, twist: Twist2) -> bool:
        """Check whether the robot is within both goal tolerances and stopped.

        Args:
            base_in_map: Robot pose in the map frame.
            twist: Velocity of the robot.
        """
        settings = self._settings
        return (
            self._is_at_goal_position(base_in_map)
            and abs(wrap(self._goal_in_map.yaw - base_in_map.yaw)) <= settings.yaw_goal_tolerance
            and abs(twist.v) <= settings.trans_stopped_vel
            and abs(twist.omega) <= settings.theta_stopped_vel
        )

    @property
    def plan_left_xy(self) -> np.ndarray:
        """The part of the plan ahead of the robot: (N, 2), in the map frame."""
        return self._progress.remaining_xy if self._progress else np.empty((0, 2))

    @property
    def distance_left(self) -> float:
        """Length of the plan ahead of the robot [m]."""
        return self._progress.distance_left if self._progress else 0.0

    def control(self, context: ControlContext, max_speeds: Twist2) -> ControlOutput:
        """Compute the velocity command for the next period.

        Args:
            context: Robot state, costmaps and dynamic obstacles.
            max_speeds: Speed limits in addition to those of the settings [m/s, rad/s].

        Returns:
            Command and predicted trajectory.

        Raises:
            ControlError: No velocity is safe.
        """
        commanded, self._commanded_omega = self._commanded_omega, None
        context = replace(context, twist=self._commanded_or_measured(context.twist, commanded))
        control = self._choose_command(context, max_speeds)
        self._commanded_omega = control.command.omega
        return control

    def _commanded_or_measured(self, twist: Twist2, commanded: Optional[float]) -> Twist2:
        """The measured velocity, but the last commanded turn rate if the robot turns distinctly faster.

        A robot with a smaller track width than its drive assumes always turns faster than commanded; starting
        from the measured rate would accelerate it further.
        """
        margin = 0.5 * self._settings.acc_lim_theta * self._period
        if commanded is None or abs(twist.omega) <= abs(commanded) + margin:
            return twist
        return Twist2(twist.v, math.copysign(commanded, twist.omega))

    def _choose_command(self, context: ControlContext, max_speeds: Twist2) -> ControlOutput:
        assert self._progress is not None, "control() needs a plan"
        base_in_map = context.base_in_map
        self._progress.advance(base_in_map.x, base_in_map.y)
        if self._is_at_goal_position(base_in_map):
            return self._turn_at_goal(context)
        map_in_local = context.base_in_local @ base_in_map.inverse()
        path_xy = _part_in_costmap(
            context.costmap, map_in_local.transform_points(self._progress.remaining_xy)
        )
        error = self._progress.heading_error(
            base_in_map.x, base_in_map.y, base_in_map.yaw, self._settings.heading_lookahead
        )
        if self._should_turn(error) and not blocks_dynamic_obstacle(self._settings, context, self._period):
            control = self._turn(error, context, path_xy)
            if control is not None:
                return control
        plan = Plan(path_xy, self._progress.distance_left)
        try:
            trajectory = self._planner.follow(context, plan, self._limits(max_speeds))
        except ControlPluginFailed:
            raise
        except ControlError as failure:
            return self._turn_or_back_out(error, context, path_xy, failure)
        return ControlOutput(trajectory.command, trajectory.poses, path_xy, trajectory.trajectory_samples)

    def _turn_or_back_out(
        self, error: float, context: ControlContext, path_xy: np.ndarray, failure: ControlError
    ) -> ControlOutput:
        """Turn towards the plan or back out of a collision if the planner failed.

        Raises:
            ControlError: Neither is possible.
        """
        control = self._turn(error, context, path_xy) if abs(error) > HEADING_TOLERANCE else None
        if control is None:
            control = self._back_out(context, path_xy, failure.trajectory_samples)
        return replace(control, trajectory_samples=failure.trajectory_samples)

    def _back_out(
        self, context: ControlContext, path_xy: np.ndarray, samples: Optional[TrajectorySamples] = None
    ) -> ControlOutput:
        """Drive so that fewer footprint points are in collision.

        Raises:
            ControlError: No velocity does so.
        """
        costmap, base_in_local = context.costmap, context.base_in_local
        command = escape_command(costmap, base_in_local) if costmap.contacts(base_in_local) else None
        if command is None:
            raise ControlError("every velocity within reach leads into an obstacle", samples)
        return ControlOutput(command, _standing_trajectory(context), path_xy)

    def _is_at_goal_position(self, base_in_map: Pose2) -> bool:
        beyond = base_in_map.distance_to(self._goal_in_map) - self._settings.xy_goal_tolerance
        stays = beyond <= LATCH_MARGIN or self._arrivals > MAX_ARRIVALS
        is_latched = self._settings.latch_xy_goal_tolerance and self._arrived and stays
        self._arrivals += beyond <= 0.0 and not self._arrived
        self._arrived = beyond <= 0.0 or is_latched
        return self._arrived

    def _should_turn(self, error: float) -> bool:
        threshold = self._settings.rotate_to_path_angle
        if threshold <= 0.0:
            return False
        self._is_turning = abs(error) > (min(ALIGNED_ANGLE, threshold) if self._is_turning else threshold)
        return self._is_turning

    def _turn_at_goal(self, context: ControlContext) -> ControlOutput:
        settings, twist = self._settings, context.twist
        here_xy = _standing_trajectory(context)[:, :2]
        error = wrap(self._goal_in_map.yaw - context.base_in_map.yaw)
        if abs(error) <= settings.yaw_goal_tolerance or abs(twist.v) > settings.trans_stopped_vel:
            return ControlOutput(
                stopping_command(settings, twist, self._period), _standing_trajectory(context), here_xy
            )
        return self._turn(error, context, here_xy) or self._back_out(context, here_xy)

    def _turn(self, error: float, context: ControlContext, path_xy: np.ndarray) -> Optional[ControlOutput]:
        """A turn in place, if there is room."""
        command = turn_in_place(self._settings, context, error, self._period)
        return None if command is None else ControlOutput(command, _standing_trajectory(context), path_xy)

    def _limits(self, max_speeds: Twist2) -> Twist2:
        """Speed limits: those of the settings, ``max_speeds``, and what allows to stop at the plan's end."""
        settings = self._settings
        stoppable = math.sqrt(2.0 * (APPROACH_DECELERATION_SHARE * settings.acc_lim_x) * self.distance_left)
        return Twist2(
            min(
                settings.max_vel_x,
                settings.max_vel_trans,
                max_speeds.v,
                max(stoppable, settings.min_vel_trans),
            ),
            min(settings.max_vel_theta, max_speeds.omega),
        )


def _standing_trajectory(context: ControlContext) -> np.ndarray:
    """A trajectory (1, 3) of the present pose only."""
    return context.base_in_local.as_array()[None, :]


def _part_in_costmap(costmap: LayeredCostmap, path_xy: np.ndarray) -> np.ndarray:
    """The plan up to where it leaves the costmap, at least one point."""
    window = costmap.window
    low = np.array([window.origin_x, window.origin_y])
    high = low + window.resolution * np.array([window.cols, window.rows])
    outside = np.flatnonzero(~((path_xy >= low) & (path_xy < high)).all(axis=1))
    return path_xy[: max(1, outside[0])] if len(outside) else path_xy
