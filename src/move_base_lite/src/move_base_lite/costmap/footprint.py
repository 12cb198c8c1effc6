"""Footprint of the robot and collision checks against a costmap."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Sequence, Tuple

import numba
import numpy as np

from move_base_lite.costmap.costs import INSCRIBED, LETHAL
from move_base_lite.costmap.window import CostmapWindow
from planar import Pose2

CIRCLE_CORNERS = 16
COLLISION = 255


@dataclass(frozen=True, eq=False)
class Footprint:
    """Outline of the robot.

    Attributes:
        corners_xy: (N, 2) corners in the base frame, padding included [m].
    """

    corners_xy: np.ndarray

    @cached_property
    def inscribed_radius(self) -> float:
        """Radius of the largest circle around the base frame's origin inside the outline [m]."""
        starts, ends = self.corners_xy, np.roll(self.corners_xy, -1, axis=0)
        edges = ends - starts
        along = np.clip(-(starts * edges).sum(axis=1) / (edges * edges).sum(axis=1), 0.0, 1.0)
        return float(np.linalg.norm(starts + along[:, None] * edges, axis=1).min())

    @cached_property
    def circumscribed_radius(self) -> float:
        """Radius of the smallest circle around the base frame's origin that contains the outline [m]."""
        return float(np.linalg.norm(self.corners_xy, axis=1).max())

    def outline_xy(self, spacing: float) -> np.ndarray:
        """Sample points along the outline.

        Args:
            spacing: Largest distance between consecutive points [m].

        Returns:
            (M, 2), in the base frame [m].
        """
        pieces = []
        for start, end in zip(self.corners_xy, np.roll(self.corners_xy, -1, axis=0)):
            count = max(1, math.ceil(float(np.linalg.norm(end - start)) / spacing))
            pieces.append(start + np.linspace(0.0, 1.0, count, endpoint=False)[:, None] * (end - start))
        return np.concatenate(pieces)


def footprint_from(corners: Sequence[Tuple[float, float]], robot_radius: float, padding: float) -> Footprint:
    """Build the footprint from parameters.

    Args:
        corners: Corners (x, y) in the base frame [m]; empty for a circle.
        robot_radius: Radius of the circle [m].
        padding: Distance by which each corner is moved outwards along both axes, as in costmap_2d [m].
    """
    corners_xy = np.array(corners, dtype=float).reshape(-1, 2)
    if not len(corners_xy):
        angles = 2.0 * math.pi * np.arange(CIRCLE_CORNERS) / CIRCLE_CORNERS
        corners_xy = robot_radius * np.column_stack((np.cos(angles), np.sin(angles)))
    return Footprint(corners_xy + padding * np.sign(np.where(np.abs(corners_xy) < 1e-9, 0.0, corners_xy)))


def collides(costs: np.ndarray, window: CostmapWindow, outline_xy: np.ndarray, pose: Pose2) -> bool:
    """Check whether an outline touches an obstacle or leaves the costmap.

    Args:
        costs: uint8 (rows, cols).
        window: Position of the cells.
        outline_xy: (M, 2) points in the base frame [m].
        pose: Pose of the base in the window's frame.
    """
    cost = footprint_cost(
        costs, window.origin_x, window.origin_y, window.resolution, outline_xy, pose.x, pose.y, pose.yaw
    )
    return bool(cost == COLLISION)


def contacts(costs: np.ndarray, window: CostmapWindow, outline_xy: np.ndarray, pose: Pose2) -> int:
    """Count the points of an outline that touch an obstacle or leave the costmap.

    Args:
        costs: uint8 (rows, cols).
        window: Position of the cells.
        outline_xy: (M, 2) points in the base frame [m].
        pose: Pose of the base in the window's frame.
    """
    return count_contacts(
        costs, window.origin_x, window.origin_y, window.resolution, outline_xy, pose.x, pose.y, pose.yaw
    )


@numba.njit(cache=True)
def footprint_cost(costs, origin_x, origin_y, resolution, outline_xy, x, y, yaw):
    """Compute the highest cost under the outline and the robot's centre.

    Args:
        costs: uint8 (rows, cols).
        origin_x: Lower left corner of the cells [m].
        origin_y: Lower left corner of the cells [m].
        resolution: Cell size [m].
        outline_xy: (M, 2) points in the base frame [m].
        x: Robot position in the costmap's frame [m].
        y: Robot position in the costmap's frame [m].
        yaw: Heading of the robot [rad].

    Returns:
        Cost; COLLISION if the robot collides or leaves the costmap.
    """
    rows, cols = costs.shape
    row = math.floor((y - origin_y) / resolution)
    col = math.floor((x - origin_x) / resolution)
    if row < 0 or row >= rows or col < 0 or col >= cols:
        return COLLISION
    highest = costs[row, col]
    if highest >= INSCRIBED:
        return COLLISION
    c, s = math.cos(yaw) / resolution, math.sin(yaw) / resolution
    base_col, base_row = (x - origin_x) / resolution, (y - origin_y) / resolution
    for i in range(outline_xy.shape[0]):
        col = math.floor(base_col + c * outline_xy[i, 0] - s * outline_xy[i, 1])
        row = math.floor(base_row + s * outline_xy[i, 0] + c * outline_xy[i, 1])
        if row < 0 or row >= rows or col < 0 or col >= cols:
            return COLLISION
        cost = costs[row, col]
        if cost >= LETHAL:
            return COLLISION
        highest = max(highest, cost)
    return highest


@numba.njit(cache=True)
def count_contacts(costs, origin_x, origin_y, resolution, outline_xy, x, y, yaw):
    """Count the colliding points of the outline, plus one if the robot's centre collides.

    Args:
        costs: uint8 (rows, cols).
        origin_x: Lower left corner of the cells [m].
        origin_y: Lower left corner of the cells [m].
        resolution: Cell size [m].
        outline_xy: (M, 2) points in the base frame [m].
        x: Robot position in the costmap's frame [m].
        y: Robot position in the costmap's frame [m].
        yaw: Heading of the robot [rad].
    """
    rows, cols = costs.shape
    c, s = math.cos(yaw) / resolution, math.sin(yaw) / resolution
    base_col, base_row = (x - origin_x) / resolution, (y - origin_y) / resolution
    col, row = math.floor(base_col), math.floor(base_row)
    count = 0
    if row < 0 or row >= rows or col < 0 or col >= cols or costs[row, col] >= INSCRIBED:
        count = 1
    for i in range(outline_xy.shape[0]):
        col = math.floor(base_col + c * outline_xy[i, 0] - s * outline_xy[i, 1])
        row = math.floor(base_row + s * outline_xy[i, 0] + c * outline_xy[i, 1])
        inside = 0 <= row < rows and 0 <= col < cols
        if not inside or costs[row, col] >= LETHAL:
            count += 1
    return count
