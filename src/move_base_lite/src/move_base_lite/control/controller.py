"""The Controller: what all local planners have in common, around the one it is given."""

import math
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from move_base_lite.control.escape import way_out
from move_base_lite.control.local_planner import Exploration, LocalPlanner, Plan, Situation
from move_base_lite.control.rotation import stopping
from move_base_lite.control.settings import ControllerSettings
from move_base_lite.control.tracking import Tracking
from move_base_lite.control.turning import turn, would_be_in_the_way
from move_base_lite.costmap import LayeredCostmap
from move_base_lite.errors import ControlError, ControlPluginFailed
from planar import Pose2, Twist2, wrap

ALIGNED_ANGLE = 0.3
FOLLOWED_ANGLE = 0.1
# Share of the acceleration with which the robot slows down towards the plan's end.
GENTLE = 0.3
# Metres that a robot which has been near its goal can be beyond the tolerance and have come there by itself,
# rolling on and turning; farther off it has been carried away, or was never there.
ROLLED = 0.1
# Arrivals after which it stays: an estimate that moves as the robot turns would have it come and go for ever.
MOST_ARRIVALS = 3


@dataclass(frozen=True, eq=False)
class Control:
    """A velocity; where it leads, poses (N, 3), and the plan followed (M, 2), both in the local frame.

    ``exploration``: what the local planner chose from, also in vain; None if it was not asked.
    """

    command: Twist2
    poses: np.ndarray
    path_xy: np.ndarray
    exploration: Optional[Exploration] = None


class Controller:
    """Follows one plan at a time; plan and goal are given in the map, costs in the local frame.

    How the plan is followed is for the local planner to say; turning to it on the spot, its end, and the way
    out of a contact are the same for all.
    """

    def __init__(self, settings: ControllerSettings, period: float, planner: LocalPlanner):
        """``period``: of control, seconds. ``planner``: made for these settings and this period."""
        self.change(settings, period, planner)
        self._tracking: Optional[Tracking] = None
        self._goal_in_map = Pose2()
        self._arrived = False
        self._arrivals = 0
        self._is_turning = False
        self._omega_told: Optional[float] = None

    def change(self, settings: ControllerSettings, period: float, planner: LocalPlanner) -> None:
        """Goes on along the same plan with other settings."""
        self._settings, self._period, self._planner = settings, period, planner

    def set_plan(self, path_xy: np.ndarray, goal_in_map: Pose2) -> None:
        """Follows another path (N, 2); a change of goal forgets that the old one had been reached."""
        self._tracking = Tracking(path_xy)
        if goal_in_map != self._goal_in_map:
            self._goal_in_map = goal_in_map
            self._arrived = self._is_turning = False
            self._arrivals = 0

    def is_goal_reached(self, base_in_map: Pose2, twist: Twist2) -> bool:
        """Within both tolerances of the goal, and at a standstill."""
        settings = self._settings
        return (
            self._is_near(base_in_map)
            and abs(wrap(self._goal_in_map.yaw - base_in_map.yaw)) <= settings.yaw_goal_tolerance
            and abs(twist.v) <= settings.trans_stopped_vel
            and abs(twist.omega) <= settings.theta_stopped_vel
        )

    @property
    def plan_left_xy(self) -> np.ndarray:
        """The plan from the robot on: (N, 2), in the map."""
        return self._tracking.ahead_xy if self._tracking else np.empty((0, 2))

    @property
    def distance_left(self) -> float:
        """Metres of the plan still to drive."""
        return self._tracking.distance_left if self._tracking else 0.0

    def control(self, situation: Situation, highest: Twist2) -> Control:
        """The velocity for the next period, within the settings and the ``highest`` speeds.

        Raises ControlError if none is safe.
        """
        told, self._omega_told = self._omega_told, None
        situation = replace(situation, twist=self._as_told(situation.twist, told))
        control = self._choose(situation, highest)
        self._omega_told = control.command.omega
        return control

    def _as_told(self, twist: Twist2, told: Optional[float]) -> Twist2:
        """The velocity measured, with the turn rate last ``told`` if the robot turns distinctly faster.

        A robot whose wheels stand closer than its drive believes always does: to brake by what is measured
        would speed it up.
        """
        margin = 0.5 * self._settings.acc_lim_theta * self._period
        if told is None or abs(twist.omega) <= abs(told) + margin:
            return twist
        return Twist2(twist.v, math.copysign(told, twist.omega))

    def _choose(self, situation: Situation, highest: Twist2) -> Control:
        assert self._tracking is not None, "control() needs a plan"
        base_in_map = situation.base_in_map
        self._tracking.advance(base_in_map.x, base_in_map.y)
        if self._is_near(base_in_map):
            return self._turn_at_goal(situation)
        map_in_local = situation.base_in_local @ base_in_map.inverse()
        path_xy = _within(situation.costmap, map_in_local.transform_points(self._tracking.ahead_xy))
        error = self._tracking.heading_error(
            base_in_map.x, base_in_map.y, base_in_map.yaw, self._settings.heading_lookahead
        )
        if self._should_turn(error) and not would_be_in_the_way(self._settings, situation, self._period):
            control = self._turn(error, situation, path_xy)
            if control is not None:
                return control
        plan = Plan(path_xy, self._tracking.distance_left)
        try:
            trajectory = self._planner.follow(situation, plan, self._limits(highest))
        except ControlPluginFailed:
            raise
        except ControlError as failure:
            return self._find_another_way(error, situation, path_xy, failure)
        return Control(trajectory.command, trajectory.poses, path_xy, trajectory.exploration)

    def _find_another_way(
        self, error: float, situation: Situation, path_xy: np.ndarray, failure: ControlError
    ) -> Control:
        """Where no way on is free: turns to the plan, or backs out of a contact. Raises ControlError."""
        control = self._turn(error, situation, path_xy) if abs(error) > FOLLOWED_ANGLE else None
        if control is None:
            control = self._back_out(situation, path_xy, failure.exploration)
        return replace(control, exploration=failure.exploration)

    def _back_out(
        self, situation: Situation, path_xy: np.ndarray, tried: Optional[Exploration] = None
    ) -> Control:
        """Leaves a contact the way that lessens it. Raises ControlError if it cannot."""
        costmap, base_in_local = situation.costmap, situation.base_in_local
        command = way_out(costmap, base_in_local) if costmap.contacts(base_in_local) else None
        if command is None:
            raise ControlError("every velocity within reach leads into an obstacle", tried)
        return Control(command, _here(situation), path_xy)

    def _is_near(self, base_in_map: Pose2) -> bool:
        beyond = base_in_map.distance_to(self._goal_in_map) - self._settings.xy_goal_tolerance
        stays = beyond <= ROLLED or self._arrivals > MOST_ARRIVALS
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

    def _turn_at_goal(self, situation: Situation) -> Control:
        settings, twist = self._settings, situation.twist
        here_xy = _here(situation)[:, :2]
        error = wrap(self._goal_in_map.yaw - situation.base_in_map.yaw)
        if abs(error) <= settings.yaw_goal_tolerance or abs(twist.v) > settings.trans_stopped_vel:
            return Control(stopping(settings, twist, self._period), _here(situation), here_xy)
        return self._turn(error, situation, here_xy) or self._back_out(situation, here_xy)

    def _turn(self, error: float, situation: Situation, path_xy: np.ndarray) -> Optional[Control]:
        """A turn on the spot, if there is room."""
        command = turn(self._settings, situation, error, self._period)
        return None if command is None else Control(command, _here(situation), path_xy)

    def _limits(self, highest: Twist2) -> Twist2:
        """The highest speeds: those of the settings, lower where asked for and to stop at the plan's end."""
        settings = self._settings
        stoppable = math.sqrt(2.0 * (GENTLE * settings.acc_lim_x) * self.distance_left)
        return Twist2(
            min(
                settings.max_vel_x,
                settings.max_vel_trans,
                highest.v,
                max(stoppable, settings.min_vel_trans),
            ),
            min(settings.max_vel_theta, highest.omega),
        )


def _here(situation: Situation) -> np.ndarray:
    """A trajectory (1, 3) that does not leave the spot."""
    return situation.base_in_local.as_array()[None, :]


def _within(costmap: LayeredCostmap, path_xy: np.ndarray) -> np.ndarray:
    """The part of the plan up to where it leaves the costmap, at least one point."""
    window = costmap.window
    low = np.array([window.origin_x, window.origin_y])
    high = low + window.resolution * np.array([window.cols, window.rows])
    outside = np.flatnonzero(~((path_xy >= low) & (path_xy < high)).all(axis=1))
    return path_xy[: max(1, outside[0])] if len(outside) else path_xy
