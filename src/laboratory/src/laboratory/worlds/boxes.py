"""Boxes that are not in the map."""

import math
from dataclasses import replace
from typing import List, Sequence

import numpy as np

from laboratory.worlds.source import Arena
from planar import FREE, Pose2, SettingsError
from planar.geometry.distance_field import distance_field
from sim_bridge.scripted_trajectories import ModelMove
from sim_bridge.simulation import box_on_floor

SIZE = (0.35, 0.35, 0.5)
# Minimum distances of a box's centre [m]: to walls, to other boxes, to start and goals.
WALL_CLEARANCE, BOX_SPACING, GOAL_CLEARANCE = 0.75, 1.2, 1.0
# Largest distance along each axis by which a box is moved from where it stood first [m].
MOVE_DISTANCE = 0.3
_STREAM, _MOVES_STREAM = 41, 52


def with_boxes(arena: Arena, count: int, seed: int, places: Sequence[Pose2]) -> Arena:
    """Add boxes at random positions.

    Args:
        arena: Arena with a map.
        count: Number of boxes.
        seed: Seed of their positions.
        places: Poses that stay free.

    Raises:
        SettingsError: The arena has no map, or no space for so many boxes.
    """
    rng = np.random.default_rng([seed, _STREAM])
    free_xy = free_box_positions(arena, places)
    poses: List[Pose2] = []
    for number in range(count):
        if not len(free_xy):
            raise SettingsError(f"there is space for {number} boxes only, not for {count}")
        x, y = free_xy[rng.integers(len(free_xy))]
        pose = Pose2(float(x), float(y), float(rng.uniform(-math.pi, math.pi)))
        poses.append(pose)
        free_xy = spaced_from(free_xy, pose)
    return with_boxes_at(arena, poses)


def with_boxes_at(arena: Arena, poses: Sequence[Pose2]) -> Arena:
    """Add boxes at the given poses."""
    boxes = [box_on_floor(f"box_{number}", SIZE, pose) for number, pose in enumerate(poses)]
    return replace(arena, world=replace(arena.world, bodies=(*arena.world.bodies, *boxes)))


def with_moves(arena: Arena, count: int, seed: int, seconds: float) -> Arena:
    """Have boxes moved at random times, each time near to where they stood first.

    Args:
        arena: Arena with boxes.
        count: Number of moves.
        seed: Seed of times, boxes and poses.
        seconds: Simulated time within which they are moved [s].

    Raises:
        SettingsError: The arena has no boxes.
    """
    boxes = [body for body in arena.world.bodies if body.model.startswith("box_")]
    if not boxes:
        raise SettingsError("moves: there are no boxes to move")
    rng = np.random.default_rng([seed, _MOVES_STREAM])
    moves = []
    for stamp in sorted(rng.uniform(0.0, seconds, count).tolist()):
        box = boxes[int(rng.integers(len(boxes)))]
        x, y = (box.pose_in_world[:2, 3] + rng.uniform(-MOVE_DISTANCE, MOVE_DISTANCE, 2)).tolist()
        moves.append(ModelMove(stamp, box.model, Pose2(x, y, float(rng.uniform(-math.pi, math.pi)))))
    return replace(arena, world=replace(arena.world, moves=tuple(moves)))


def free_box_positions(arena: Arena, places: Sequence[Pose2]) -> np.ndarray:
    """Return positions (N, 2) where a robot can pass a box, away from ``places``.

    Raises:
        SettingsError: The arena has no map.
    """
    if arena.grid is None:
        raise SettingsError("boxes need a world with a map")
    clearance = distance_field(arena.grid.cells != FREE, arena.grid.resolution)
    free_xy = arena.grid.points_of(np.argwhere(clearance > WALL_CLEARANCE))
    for place in places:
        free_xy = free_xy[np.hypot(*(free_xy - (place.x, place.y)).T) > GOAL_CLEARANCE]
    return free_xy


def spaced_from(free_xy: np.ndarray, box: Pose2) -> np.ndarray:
    """Return those of the positions (N, 2) where a robot can pass between ``box`` and another box."""
    return free_xy[np.hypot(*(free_xy - (box.x, box.y)).T) > BOX_SPACING]
