"""Plans from SDF worlds, those of Gazebo's Building Editor among them."""

import math
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import List, Optional

import numpy as np
from shapely.geometry import MultiPoint, Polygon

from home_builder.errors import ImportPlanError
from home_builder.imports.joints import join_walls, rounded
from home_builder.imports.outlines import piece_of
from home_builder.plan.model import FurniturePiece, HomePlan, Wall
from sim_bridge import load_world
from sim_bridge.geometry.shapes import Box, Plane
from sim_bridge.geometry.slicing import slice_shape
from sim_bridge.world import Collision

# A wall is at most so thick, at least so long and so high [m]; it stands on the floor.
MAX_THICKNESS, MIN_LENGTH, MIN_HEIGHT, MAX_BOTTOM = 0.4, 0.4, 0.8, 0.1
# Height at which other solids are cut, as a laser sees them [m], and height of those whose top is unknown.
CUT, DEFAULT_HEIGHT = 0.3, 0.8
# Uncertainty of the ends of walls [m].
SLACK = 0.02
# Most pieces, and how far their outlines may be simplified [m].
MAX_PIECES, ROUNDING = 2000, 0.01


def import_world(path: Path) -> HomePlan:
    """Make a plan of an SDF world: upright boxes become walls, other solids furniture.

    Args:
        path: World of SDF 1.4 to 1.9.

    Returns:
        The plan, in the frame of the world; the robot starts at the origin.

    Raises:
        WorldError: The world cannot be read.
        ImportPlanError: It has no walls.
    """
    world = load_world(path)
    walls: List[Wall] = []
    furniture: List[FurniturePiece] = []
    for body in world.bodies:
        for part in body.collisions:
            pose = body.pose_in_world @ part.pose_in_body
            wall = _wall(part, pose)
            if wall is not None:
                walls.append(wall)
            elif not isinstance(part.shape, Plane):
                furniture += _pieces(part, pose, body.model if len(body.collisions) == 1 else "")
    if not walls:
        raise ImportPlanError(
            f"{path}: the world has no walls, that is upright boxes that stand on the floor"
        )
    if len(furniture) > MAX_PIECES:
        raise ImportPlanError(f"{path}: {len(furniture)} solids are more than {MAX_PIECES}")
    joined = join_walls(walls, SLACK)
    return HomePlan(path.stem, tuple(map(rounded, joined)), tuple(_with_single_names(furniture)))


def _wall(part: Collision, pose: np.ndarray) -> Optional[Wall]:
    """Return a collision as a wall; None if it is none."""
    if not isinstance(part.shape, Box) or abs(pose[2, 2]) < 0.999:
        return None
    length, depth, height = part.shape.size
    yaw = math.atan2(pose[1, 0], pose[0, 0])
    if depth > length:
        length, depth, yaw = depth, length, yaw + math.pi / 2.0
    bottom = float(pose[2, 3]) - height / 2.0
    is_wall = depth <= MAX_THICKNESS and length >= MIN_LENGTH and length > depth and height >= MIN_HEIGHT
    if not is_wall or bottom > MAX_BOTTOM:
        return None
    half_x, half_y = length / 2.0 * math.cos(yaw), length / 2.0 * math.sin(yaw)
    x, y = float(pose[0, 3]), float(pose[1, 3])
    return Wall((x - half_x, y - half_y), (x + half_x, y + half_y), depth, bottom + height)


def _pieces(part: Collision, pose: np.ndarray, name: str) -> List[FurniturePiece]:
    """Return the convex outlines of a solid at the height of a laser as furniture."""
    pieces = []
    for outline in slice_shape(part.shape, pose, CUT - 0.005, CUT + 0.005):
        hull = MultiPoint(outline).convex_hull.simplify(ROUNDING)
        if isinstance(hull, Polygon) and hull.area > 1e-4:
            pieces.append(piece_of(hull, DEFAULT_HEIGHT, name))
    return pieces


def _with_single_names(furniture: List[FurniturePiece]) -> List[FurniturePiece]:
    """Keep the names that one piece only has."""
    counts = Counter(piece.name for piece in furniture)
    return [piece if counts[piece.name] == 1 else replace(piece, name="") for piece in furniture]
