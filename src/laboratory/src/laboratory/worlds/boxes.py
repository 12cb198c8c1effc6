"""Boxes that a map does not show."""

import math
from dataclasses import replace
from typing import List, Sequence

import numpy as np

from laboratory.worlds.source import Arena
from planar import FREE, Pose2, SettingsError
from planar.geometry.distance_field import distance_field
from sim_bridge.simulation import box_on_floor

SIZE = (0.35, 0.35, 0.5)
# Metres: from a box's middle to a wall, so that a robot gets past, to another box, and to start and goals.
WALL_CLEARANCE, BOX_SPACING, GOAL_CLEARANCE = 0.75, 1.2, 1.0
_STREAM = 41


def with_boxes(arena: Arena, count: int, seed: int, places: Sequence[Pose2]) -> Arena:
    """The arena with so many boxes anywhere off its walls and off ``places``.

    Raises SettingsError if the arena has no map or no room for them.
    """
    rng = np.random.default_rng([seed, _STREAM])
    free_xy = free_box_positions(arena, places)
    poses: List[Pose2] = []
    for number in range(count):
        if not len(free_xy):
            raise SettingsError(f"there is room for {number} boxes only, not for {count}")
        x, y = free_xy[rng.integers(len(free_xy))]
        pose = Pose2(float(x), float(y), float(rng.uniform(-math.pi, math.pi)))
        poses.append(pose)
        free_xy = spaced_from(free_xy, pose)
    return with_boxes_at(arena, poses)


def with_boxes_at(arena: Arena, poses: Sequence[Pose2]) -> Arena:
    """The arena with boxes there."""
    boxes = [box_on_floor(f"box_{number}", SIZE, pose) for number, pose in enumerate(poses)]
    return replace(arena, world=replace(arena.world, bodies=(*arena.world.bodies, *boxes)))


def free_box_positions(arena: Arena, places: Sequence[Pose2]) -> np.ndarray:
    """Where a box leaves a way past, off ``places``; (N, 2). Raises SettingsError without a map."""
    if arena.grid is None:
        raise SettingsError("boxes need a world with a map")
    clearance = distance_field(arena.grid.cells != FREE, arena.grid.resolution)
    free_xy = arena.grid.points_of(np.argwhere(clearance > WALL_CLEARANCE))
    for place in places:
        free_xy = free_xy[np.hypot(*(free_xy - (place.x, place.y)).T) > GOAL_CLEARANCE]
    return free_xy


def spaced_from(free_xy: np.ndarray, box: Pose2) -> np.ndarray:
    """Those of some spots (N, 2) where another leaves a way between."""
    return free_xy[np.hypot(*(free_xy - (box.x, box.y)).T) > BOX_SPACING]
