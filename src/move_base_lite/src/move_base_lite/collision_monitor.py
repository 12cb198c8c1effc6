"""Slows and stops whatever the robot is told to do, by what its sensors see at this moment.

No map, no memory, no plan: the last thing between any command, teleoperated too, and the wheels
(after nav2_collision_monitor's "approach" and "stop" zones).
"""

import math
from dataclasses import dataclass
from typing import Tuple

import numba
import numpy as np

from move_base_lite.costmap import Footprint, footprint_from
from planar import Twist2
from planar.config.parameters import POSITIVE, at_least, check_parameters, parameter
from planar.config.settings import check

STEPS = 20
# Metres that the robot must come closer by to count as doing so: a circle is a polygon here.
CLOSER = 0.005
# Metres inside the outline from which on a point belongs to the robot itself.
OWN_BODY = 0.03
CLEAR, SLOWED, STOPPED = "clear", "slowed", "stopped"


@dataclass(frozen=True)
class MonitorSettings:
    """The robot's outline, and how near it is to come to anything."""

    footprint: Tuple[Tuple[float, float], ...] = parameter(
        (), "corners [x, y] in the base frame; empty: a circle of robot_radius", "m"
    )
    robot_radius: float = parameter(0.18, "of a round footprint", "m", POSITIVE)
    stop_distance: float = parameter(
        0.05,
        "clearance around the robot at which it is stopped, unless it moves away",
        "m",
        at_least(0.0),
    )
    time_to_collision: float = parameter(
        1.0, "the robot is slowed so that it would take so long to come as close as that", "s", POSITIVE
    )
    scan_timeout: float = parameter(0.5, "without a scan until it is stopped", "s", POSITIVE)

    def __post_init__(self):
        check_parameters(self)
        check(len(self.footprint) not in (1, 2), "footprint", "at least 3 points", self.footprint)


@dataclass(frozen=True)
class LimitedCommand:
    """The command that may pass, and why: clear, slowed or stopped."""

    command: Twist2
    reason: str


class CollisionMonitor:
    """Looks at one command at a time."""

    def __init__(self, settings: MonitorSettings):
        self._settings = settings
        outline: Footprint = footprint_from(settings.footprint, settings.robot_radius, 0.0)
        self._corners_xy = outline.corners_xy

    def limit_command(self, command: Twist2, points_xy: np.ndarray) -> LimitedCommand:
        """What of a command may pass; ``points_xy``: (N, 2), obstacles in the base frame, metres.

        The robot is followed along the command's arc. A point that is within the stop distance already does
        not count as long as the robot moves away from it.
        """
        if command == Twist2():
            return LimitedCommand(command, CLEAR)
        settings = self._settings
        seconds = _free_seconds(
            self._corners_xy,
            points_xy,
            command.v,
            command.omega,
            settings.stop_distance,
            settings.time_to_collision,
        )
        share = seconds / settings.time_to_collision
        if share >= 1.0:
            return LimitedCommand(command, CLEAR)
        if share <= 1.0 / STEPS:
            return LimitedCommand(Twist2(), STOPPED)
        return LimitedCommand(Twist2(share * command.v, share * command.omega), SLOWED)


@numba.njit(cache=True)
def _free_seconds(corners, points, v, omega, margin, horizon):
    """Seconds until a point comes closer to the moving outline than the margin, or closer still; at most the
    horizon."""
    dt = horizon / STEPS
    nearest = np.empty(points.shape[0])
    for i in range(points.shape[0]):
        nearest[i] = _distance(corners, points[i, 0], points[i, 1])
    x, y, yaw = 0.0, 0.0, 0.0
    for step in range(1, STEPS + 1):
        x += v * dt * math.cos(yaw + 0.5 * omega * dt)
        y += v * dt * math.sin(yaw + 0.5 * omega * dt)
        yaw += omega * dt
        c, s = math.cos(yaw), math.sin(yaw)
        for i in range(points.shape[0]):
            if nearest[i] < -OWN_BODY:
                continue
            along, across = points[i, 0] - x, points[i, 1] - y
            distance = _distance(corners, c * along + s * across, c * across - s * along)
            if distance < margin and distance < nearest[i] - CLOSER:
                return (step - 1) * dt
    return horizon


@numba.njit(cache=True)
def _distance(corners, x, y):
    """Metres from the polygon, negative inside."""
    squared, inside = np.inf, False
    for i in range(corners.shape[0]):
        x0, y0 = corners[i - 1]
        x1, y1 = corners[i]
        along_x, along_y = x1 - x0, y1 - y0
        share = ((x - x0) * along_x + (y - y0) * along_y) / (along_x * along_x + along_y * along_y)
        share = min(max(share, 0.0), 1.0)
        squared = min(squared, (x - x0 - share * along_x) ** 2 + (y - y0 - share * along_y) ** 2)
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * along_x:
            inside = not inside
    return -math.sqrt(squared) if inside else math.sqrt(squared)
