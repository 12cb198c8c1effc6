"""Collision monitor: slows or stops any velocity command by the latest scan (nav2_collision_monitor).

It uses no map and no plan, so it also protects teleoperation. It combines the "approach" and "stop" models of
nav2_collision_monitor.
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
# Decrease of the distance that counts as approaching [m]; a circle is approximated by a polygon.
APPROACH_TOLERANCE = 0.005
# Metres inside the outline beyond which a point belongs to the robot itself.
SELF_MARGIN = 0.03
CLEAR, SLOWED, STOPPED = "clear", "slowed", "stopped"


@dataclass(frozen=True)
class MonitorSettings:
    """Parameters of the collision monitor.

    Raises:
        SettingsError: On construction, for a value out of bounds.
    """

    footprint: Tuple[Tuple[float, float], ...] = parameter(
        (), "corners [x, y] in the base frame; empty: a circle of robot_radius", "m"
    )
    robot_radius: float = parameter(0.18, "of a round footprint", "m", POSITIVE)
    stop_distance: float = parameter(
        0.05,
        "clearance at which the robot is stopped, unless it moves away",
        "m",
        at_least(0.0),
    )
    time_to_collision: float = parameter(
        1.0, "time until stop_distance to which the robot is slowed", "s", POSITIVE
    )
    scan_timeout: float = parameter(
        0.5, "time without a scan after which the robot is stopped", "s", POSITIVE
    )

    def __post_init__(self):
        check_parameters(self)
        check(len(self.footprint) not in (1, 2), "footprint", "at least 3 points", self.footprint)


@dataclass(frozen=True)
class LimitedCommand:
    """A velocity command after the collision check.

    Attributes:
        command: Command to execute.
        reason: Action taken: clear, slowed or stopped.
    """

    command: Twist2
    reason: str


class CollisionMonitor:
    """Checks one command at a time against the points of a scan."""

    def __init__(self, settings: MonitorSettings):
        """Create the monitor.

        Args:
            settings: Footprint, stop distance and time to collision.
        """
        self._settings = settings
        outline: Footprint = footprint_from(settings.footprint, settings.robot_radius, 0.0)
        self._corners_xy = outline.corners_xy

    def limit_command(self, command: Twist2, points_xy: np.ndarray) -> LimitedCommand:
        """Limit a command so that the robot does not collide.

        The robot is simulated along the command's arc. A point that is already within the stop distance is
        ignored while the robot moves away from it.

        Args:
            command: Commanded velocity.
            points_xy: (N, 2) obstacle points in the base frame [m].

        Returns:
            The command, slowed or stopped if necessary.
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
        fraction = seconds / settings.time_to_collision
        if fraction >= 1.0:
            return LimitedCommand(command, CLEAR)
        if fraction <= 1.0 / STEPS:
            return LimitedCommand(Twist2(), STOPPED)
        return LimitedCommand(Twist2(fraction * command.v, fraction * command.omega), SLOWED)


@numba.njit(cache=True)
def _free_seconds(corners, points, v, omega, margin, horizon):
    """Time until a point comes within the margin of the moving outline; at most the horizon [s]."""
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
            if nearest[i] < -SELF_MARGIN:
                continue
            along, across = points[i, 0] - x, points[i, 1] - y
            distance = _distance(corners, c * along + s * across, c * across - s * along)
            if distance < margin and distance < nearest[i] - APPROACH_TOLERANCE:
                return (step - 1) * dt
    return horizon


@numba.njit(cache=True)
def _distance(corners, x, y):
    """Signed distance from the polygon [m], negative inside."""
    squared, inside = np.inf, False
    for i in range(corners.shape[0]):
        x0, y0 = corners[i - 1]
        x1, y1 = corners[i]
        along_x, along_y = x1 - x0, y1 - y0
        fraction = ((x - x0) * along_x + (y - y0) * along_y) / (along_x * along_x + along_y * along_y)
        fraction = min(max(fraction, 0.0), 1.0)
        squared = min(squared, (x - x0 - fraction * along_x) ** 2 + (y - y0 - fraction * along_y) ** 2)
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * along_x:
            inside = not inside
    return -math.sqrt(squared) if inside else math.sqrt(squared)
