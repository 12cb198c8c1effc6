"""The local planner: turns to the plan, follows it, stops at the end and turns as the goal says."""

import math
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from move_base_lite.control.dwa import DynamicWindow
from move_base_lite.control.escape import way_out
from move_base_lite.control.exploration import Exploration
from move_base_lite.control.mppi import PathIntegral
from move_base_lite.control.rotation import rotation_towards, stopping
from move_base_lite.control.settings import ControllerSettings, DwaSettings, MppiSettings
from move_base_lite.control.tracking import Tracking
from move_base_lite.costmap import LayeredCostmap
from move_base_lite.errors import ControlError
from planar import Pose2, Twist2, wrap

ALIGNED_ANGLE = 0.3
FOLLOWED_ANGLE = 0.1
# Metres between the places checked on the way to a standstill, and how much longer that is taken to be.
STOPPING_STEP = 0.05
STOPPING_MARGIN = 1.3
# Seconds for which a robot that stands still looks out for what moves, and metres at which that is to pass.
SOON, PASSING = 3.0, 0.3


@dataclass(frozen=True, eq=False)
class Situation:
    """What a velocity is chosen from: the robot's poses and speed, obstacles, limits, and what moves.

    ``highest``: what anything but the settings allows. ``movers``: in the local frame (see Movers).
    """

    base_in_map: Pose2
    base_in_local: Pose2
    twist: Twist2
    costmap: LayeredCostmap
    highest: Twist2
    movers: np.ndarray


@dataclass(frozen=True, eq=False)
class Control:
    """A velocity; where it leads, poses (N, 3), and the plan followed (M, 2), both in the local frame."""

    command: Twist2
    poses: np.ndarray
    plan_xy: np.ndarray


class Controller:
    """Follows one plan at a time; plan and goal are given in the map, costs in the local frame.

    How it is followed is for a DynamicWindow or a PathIntegral to say; turning on the spot, the end of the
    plan and the way out of a contact are the same for both.
    """

    def __init__(self, settings: ControllerSettings, period: float):
        self._settings = settings
        self._period = period
        self._follower = follower_for(settings, period)
        self._tracking: Optional[Tracking] = None
        self._goal_in_map = Pose2()
        self._arrived = False
        self._is_turning = False
        self._omega_told: Optional[float] = None

    def change(self, settings: ControllerSettings, period: float) -> None:
        """Goes on along the same plan with other settings."""
        if (settings, period) != (self._settings, self._period):
            self._settings, self._period = settings, period
            self._follower = follower_for(settings, period)

    def set_plan(self, path_xy: np.ndarray, goal_in_map: Pose2) -> None:
        """Follows another path (N, 2); a change of goal forgets that the old one had been reached."""
        self._tracking = Tracking(path_xy)
        if goal_in_map != self._goal_in_map:
            self._goal_in_map = goal_in_map
            self._arrived = self._is_turning = False

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

    @property
    def exploration(self) -> Optional[Exploration]:
        """What the last control() chose from, also in vain; None if it was another way."""
        return self._follower.exploration

    def control(self, situation: Situation) -> Control:
        """The velocity for the next period, within the settings and the highest speeds.

        Raises ControlError if none is safe.
        """
        told, self._omega_told = self._omega_told, None
        self._follower.exploration = None
        control = self._choose(replace(situation, twist=self._as_told(situation.twist, told)))
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

    def _choose(self, situation: Situation) -> Control:
        assert self._tracking is not None, "control() needs a plan"
        base_in_map, base_in_local = situation.base_in_map, situation.base_in_local
        self._tracking.advance(base_in_map.x, base_in_map.y)
        if self._is_near(base_in_map):
            return self._turn_at_goal(situation)
        map_in_local = base_in_local @ base_in_map.inverse()
        plan_xy = _within(situation.costmap, map_in_local.transform_points(self._tracking.ahead_xy))
        error = self._tracking.heading_error(
            base_in_map.x, base_in_map.y, base_in_map.yaw, self._settings.heading_lookahead
        )
        turn = None
        if self._should_turn(error) and not self._is_in_the_way(situation):
            turn = self._turn(error, situation, plan_xy)
        if turn is not None:
            return turn
        try:
            trajectory = self._follower.follow(
                situation.costmap,
                base_in_local,
                situation.twist,
                plan_xy,
                self._within_limits(situation.highest),
                self.distance_left,
                situation.movers,
            )
        except ControlError:
            return self._find_another_way(error, situation, plan_xy)
        return Control(trajectory.command, trajectory.poses, plan_xy)

    def _find_another_way(self, error: float, situation: Situation, plan_xy: np.ndarray) -> Control:
        """Where no way on is free: turns to the plan, or backs out of a contact. Raises ControlError."""
        turn = None
        if abs(error) > FOLLOWED_ANGLE:
            turn = self._turn(error, situation, plan_xy)
        return turn or self._back_out(situation, plan_xy)

    def _back_out(self, situation: Situation, plan_xy: np.ndarray) -> Control:
        """Leaves a contact the way that lessens it. Raises ControlError if it cannot."""
        costmap, base_in_local = situation.costmap, situation.base_in_local
        command = way_out(costmap, base_in_local) if costmap.contacts(base_in_local) else None
        if command is None:
            raise ControlError("every velocity within reach leads into an obstacle")
        return Control(command, base_in_local.as_array()[None, :], plan_xy)

    def _is_near(self, base_in_map: Pose2) -> bool:
        is_near = base_in_map.distance_to(self._goal_in_map) <= self._settings.xy_goal_tolerance
        if self._settings.latch_xy_goal_tolerance:
            self._arrived = self._arrived or is_near
            return self._arrived
        return is_near

    def _should_turn(self, error: float) -> bool:
        threshold = self._settings.rotate_to_path_angle
        if threshold <= 0.0:
            return False
        self._is_turning = abs(error) > (min(ALIGNED_ANGLE, threshold) if self._is_turning else threshold)
        return self._is_turning

    def _turn_at_goal(self, situation: Situation) -> Control:
        settings, twist = self._settings, situation.twist
        here = situation.base_in_local.as_array()[None, :]
        error = wrap(self._goal_in_map.yaw - situation.base_in_map.yaw)
        if abs(error) <= settings.yaw_goal_tolerance or abs(twist.v) > settings.trans_stopped_vel:
            return Control(stopping(settings, twist, self._period), here, here[:, :2])
        turn = self._turn(error, situation, here[:, :2])
        return turn or self._back_out(situation, here[:, :2])

    def _turn(self, error: float, situation: Situation, plan_xy: np.ndarray) -> Optional[Control]:
        """Turns on the spot, the other way round if this one is obstructed; None if there is no room.

        A robot that drives has to come to a standstill first, and there must be room for that too.
        """
        if not self._can_stop(situation):
            return None
        for angle in (error, error - math.copysign(2.0 * math.pi, error)):
            if situation.costmap.has_room_to_turn(situation.base_in_local, angle):
                command = rotation_towards(self._settings, angle, situation.twist, self._period)
                return Control(command, situation.base_in_local.as_array()[None, :], plan_xy)
        return None

    def _is_in_the_way(self, situation: Situation) -> bool:
        """Whether something that moves would soon come near the robot if that stopped here."""
        movers = situation.movers
        here = situation.base_in_local @ Pose2(self._stopping_distance(situation.twist), 0.0)
        offsets, velocities = movers[:, :2] - (here.x, here.y), movers[:, 2:4]
        closest_at = -(offsets * velocities).sum(axis=1) / np.maximum((velocities**2).sum(axis=1), 1e-6)
        passing = offsets + velocities * np.clip(closest_at, 0.0, SOON)[:, None]
        reach = movers[:, 4] + situation.costmap.footprint.circumscribed_radius + PASSING
        return bool((np.hypot(passing[:, 0], passing[:, 1]) < reach).any())

    def _stopping_distance(self, twist: Twist2) -> float:
        """Metres, negative backwards."""
        return twist.v * (self._period + abs(twist.v) / (2.0 * self._settings.acc_lim_x))

    def _can_stop(self, situation: Situation) -> bool:
        """Whether the robot touches nothing new where it would stand after braking."""
        costmap, base_in_local = situation.costmap, situation.base_in_local
        way = STOPPING_MARGIN * self._stopping_distance(situation.twist)
        if abs(way) < costmap.window.resolution:
            return True
        touching = costmap.contacts(base_in_local)
        steps = way * np.linspace(0.0, 1.0, math.ceil(abs(way) / STOPPING_STEP) + 1)[1:]
        return all(costmap.contacts(base_in_local @ Pose2(float(step), 0.0)) <= touching for step in steps)

    def _within_limits(self, highest: Twist2) -> Twist2:
        """The highest speeds: those of the settings, lower where asked for and to stop at the plan's end."""
        settings = self._settings
        gentle = 0.3 * settings.acc_lim_x
        stoppable = max(math.sqrt(2.0 * gentle * self.distance_left), settings.min_vel_trans)
        return Twist2(
            min(settings.max_vel_x, settings.max_vel_trans, highest.v, stoppable),
            min(settings.max_vel_theta, highest.omega),
        )


def follower_for(settings: ControllerSettings, period: float):
    """The local planner that the settings are meant for."""
    if isinstance(settings, MppiSettings):
        return PathIntegral(settings, period)
    assert isinstance(settings, DwaSettings)
    return DynamicWindow(settings, period)


def _within(costmap: LayeredCostmap, plan_xy: np.ndarray) -> np.ndarray:
    """The part of the plan up to where it leaves the costmap, at least one point."""
    window = costmap.window
    low = np.array([window.origin_x, window.origin_y])
    high = low + window.resolution * np.array([window.cols, window.rows])
    outside = np.flatnonzero(~((plan_xy >= low) & (plan_xy < high)).all(axis=1))
    return plan_xy[: max(1, outside[0])] if len(outside) else plan_xy
