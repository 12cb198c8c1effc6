"""Turning on the spot: whether there is room for it, and how."""

import math
from typing import Optional

import numpy as np

from move_base_lite.control.local_planner import Situation
from move_base_lite.control.rotation import rotation_towards
from move_base_lite.control.settings import ControllerSettings
from planar import Pose2, Twist2

# Metres between the places checked on the way to a standstill, and how much longer that is taken to be.
STOPPING_STEP = 0.05
STOPPING_MARGIN = 1.3
# Seconds for which a robot that stands still looks out for what moves, and metres at which that is to pass.
SOON, PASSING = 3.0, 0.3


def turn(settings: ControllerSettings, situation: Situation, error: float, period: float) -> Optional[Twist2]:
    """Takes off ``error`` radians, the other way round if this one is obstructed; None if there is no room.

    A robot that drives has to come to a standstill first, and there must be room for that too.
    """
    if not can_stop(settings, situation, period):
        return None
    for angle in (error, error - math.copysign(2.0 * math.pi, error)):
        if situation.costmap.has_room_to_turn(situation.base_in_local, angle):
            return rotation_towards(settings, angle, situation.twist, period)
    return None


def can_stop(settings: ControllerSettings, situation: Situation, period: float) -> bool:
    """Whether the robot touches nothing new where it would stand after braking."""
    costmap, base_in_local = situation.costmap, situation.base_in_local
    way = STOPPING_MARGIN * stopping_distance(settings, situation.twist, period)
    if abs(way) < costmap.window.resolution:
        return True
    touching = costmap.contacts(base_in_local)
    steps = way * np.linspace(0.0, 1.0, math.ceil(abs(way) / STOPPING_STEP) + 1)[1:]
    return all(costmap.contacts(base_in_local @ Pose2(float(step), 0.0)) <= touching for step in steps)


def would_be_in_the_way(settings: ControllerSettings, situation: Situation, period: float) -> bool:
    """Whether something that moves would soon come near the robot if that stopped here."""
    movers = situation.movers
    here = situation.base_in_local @ Pose2(stopping_distance(settings, situation.twist, period), 0.0)
    offsets, velocities = movers[:, :2] - (here.x, here.y), movers[:, 2:4]
    closest_at = -(offsets * velocities).sum(axis=1) / np.maximum((velocities**2).sum(axis=1), 1e-6)
    passing = offsets + velocities * np.clip(closest_at, 0.0, SOON)[:, None]
    reach = movers[:, 4] + situation.costmap.footprint.circumscribed_radius + PASSING
    return bool((np.hypot(passing[:, 0], passing[:, 1]) < reach).any())


def stopping_distance(settings: ControllerSettings, twist: Twist2, period: float) -> float:
    """Metres until the robot stands, negative backwards."""
    return twist.v * (period + abs(twist.v) / (2.0 * settings.acc_lim_x))
