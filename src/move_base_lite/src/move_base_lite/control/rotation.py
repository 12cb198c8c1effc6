"""Turning in place: the command, and whether there is room for it."""

import math
from typing import Optional

import numpy as np

from move_base_lite.control.local_planner import ControlContext
from move_base_lite.control.settings import ControllerSettings
from planar import Pose2, Twist2

# Share of the angular acceleration with which a turn is braked.
BRAKING_SHARE = 0.7
# Spacing of the poses checked on the stopping distance [m], and safety factor of that distance.
STOPPING_STEP = 0.05
STOPPING_MARGIN = 1.3
# Time for which dynamic obstacles are predicted [s], and the distance at which they have to pass [m].
PASSING_HORIZON, PASSING_DISTANCE = 3.0, 0.3


def turn_in_place(
    settings: ControllerSettings, context: ControlContext, error: float, period: float
) -> Optional[Twist2]:
    """Compute the command that reduces a heading error by turning in place.

    If the shorter direction is obstructed, the robot turns the other way.

    Args:
        settings: Limits of speed and acceleration.
        context: Robot state and costmaps.
        error: Angle to turn by [rad].
        period: Control period [s].

    Returns:
        The command; None if there is no room to turn, or to stop first if the robot moves.
    """
    if not can_stop(settings, context, period):
        return None
    for angle in (error, error - math.copysign(2.0 * math.pi, error)):
        if context.costmap.has_room_to_turn(context.base_in_local, angle):
            return rotation_towards(settings, angle, context.twist, period)
    return None


def can_stop(settings: ControllerSettings, context: ControlContext, period: float) -> bool:
    """Check whether the robot can stop without another point of its footprint in collision.

    Args:
        settings: Acceleration limit.
        context: Robot state and costmaps.
        period: Control period [s].
    """
    costmap, base_in_local = context.costmap, context.base_in_local
    distance = STOPPING_MARGIN * stopping_distance(settings, context.twist, period)
    if abs(distance) < costmap.window.resolution:
        return True
    contacts = costmap.contacts(base_in_local)
    steps = distance * np.linspace(0.0, 1.0, math.ceil(abs(distance) / STOPPING_STEP) + 1)[1:]
    return all(costmap.contacts(base_in_local @ Pose2(float(step), 0.0)) <= contacts for step in steps)


def blocks_dynamic_obstacle(settings: ControllerSettings, context: ControlContext, period: float) -> bool:
    """Check whether a dynamic obstacle would soon come near the robot if it stopped here.

    Args:
        settings: Acceleration limit, for the stopping distance.
        context: Robot state and dynamic obstacles.
        period: Control period [s].
    """
    obstacles = context.dynamic_obstacles
    stop = context.base_in_local @ Pose2(stopping_distance(settings, context.twist, period), 0.0)
    offsets, velocities = obstacles[:, :2] - (stop.x, stop.y), obstacles[:, 2:4]
    closest_at = -(offsets * velocities).sum(axis=1) / np.maximum((velocities**2).sum(axis=1), 1e-6)
    passing = offsets + velocities * np.clip(closest_at, 0.0, PASSING_HORIZON)[:, None]
    reach = obstacles[:, 4] + context.costmap.footprint.circumscribed_radius + PASSING_DISTANCE
    return bool((np.hypot(passing[:, 0], passing[:, 1]) < reach).any())


def stopping_distance(settings: ControllerSettings, twist: Twist2, period: float) -> float:
    """Compute the distance until the robot stands.

    Args:
        settings: Acceleration limit.
        twist: Velocity of the robot.
        period: Control period, in which the robot does not decelerate yet [s].

    Returns:
        Distance [m], negative if the robot drives backwards.
    """
    return twist.v * (period + abs(twist.v) / (2.0 * settings.acc_lim_x))


def rotation_towards(settings: ControllerSettings, error: float, twist: Twist2, period: float) -> Twist2:
    """Compute the command that turns by an angle, as fast as the robot can still stop; it reduces v first.

    Args:
        settings: Limits of turn rate and acceleration.
        error: Angle to turn by [rad].
        twist: Velocity of the robot.
        period: Control period [s].
    """
    stoppable = math.sqrt(2.0 * BRAKING_SHARE * settings.acc_lim_theta * abs(error))
    speed = min(max(stoppable, settings.min_vel_theta), settings.max_vel_theta, abs(error) / period)
    target = math.copysign(speed, error)
    change = settings.acc_lim_theta * period
    omega = min(max(target, twist.omega - change), twist.omega + change)
    return Twist2(braked(twist.v, settings.acc_lim_x * period), omega)


def stopping_command(settings: ControllerSettings, twist: Twist2, period: float) -> Twist2:
    """Compute the command nearest to a standstill that the acceleration limits allow.

    Args:
        settings: Limits of acceleration.
        twist: Velocity of the robot.
        period: Control period [s].
    """
    return Twist2(
        braked(twist.v, settings.acc_lim_x * period), braked(twist.omega, settings.acc_lim_theta * period)
    )


def braked(speed: float, change: float) -> float:
    """Reduce the magnitude of a speed by ``change``, at most to zero."""
    return math.copysign(max(abs(speed) - change, 0.0), speed)
