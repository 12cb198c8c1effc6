"""Worlds to drive in besides the home: drawn as pictures, built of boxes."""

from typing import List, Tuple

import numpy as np

from planar import Pose2
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Box, Plane
from sim_bridge.world import Body, Collision, World

CELL_METRES, WALL_HEIGHT = 0.5, 1.0

# A corridor of 29 m with rooms on both sides: along it, the laser sees the same for metres.
HALLWAY = """
############################################################
#........#...........#......#..........#..........#........#
#........#...........#......#..........#...##.....#........#
#........#...........#......#..........#...##.....#........#
#........#...........#......#..........#..........#........#
###...#######...#########..######...########...#######...###
#..........................................................#
#..........................................................#
#..........................................................#
####...########...#######...#########...######...########..#
#........#...........#.........#..........#..........#.....#
#...##...#...........#.........#..........#..........#.....#
#...##...#.....#.....#.........#....###...#..........#.....#
#........#...........#.........#..........#..........#.....#
############################################################
"""

# One big office with desks that all look alike, pillars and a niche.
OFFICE = """
########################################
#......................................#
#......................................#
#..####...####...####...####...........#
#..####...####...####...####......##...#
#.................................##...#
#......................................#
#..####...####.........................#
#..####...####......#..............#####
#......................................#
#......................................#
#..####...####...####...####...........#
#..####...####...####...####......##...#
#.................................##...#
#......................................#
########################################
"""


def world_from_picture(name: str, picture: str) -> World:
    """Walls where ``picture`` has ``#``; its lower left corner is the origin."""
    rows = picture.strip("\n").splitlines()[::-1]
    solid = np.array([[mark == "#" for mark in row] for row in rows])
    walls = [_wall(f"wall_{i}", *rectangle) for i, rectangle in enumerate(_rectangles(solid))]
    floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
    return World(name, (floor, *walls))


def _wall(name: str, row: int, col: int, rows: int, cols: int) -> Body:
    size = (cols * CELL_METRES, rows * CELL_METRES, WALL_HEIGHT)
    centre = Pose2((col + cols / 2.0) * CELL_METRES, (row + rows / 2.0) * CELL_METRES, 0.0)
    in_world = from_pose2(centre, z=WALL_HEIGHT / 2.0)
    return Body(f"{name}::link", in_world, (Collision(Box(size), np.eye(4)),))


def _rectangles(solid: np.ndarray) -> List[Tuple[int, int, int, int]]:
    """Rectangles (row, col, rows, cols) that cover what is solid, each as wide and then as high as can be."""
    left, found = solid.copy(), []
    while left.any():
        row, col = (int(index[0]) for index in np.nonzero(left))
        cols = int(np.argmin(np.append(left[row, col:], False)))
        rows = int(np.argmin(np.append(left[row:, col : col + cols].all(axis=1), False)))
        left[row : row + rows, col : col + cols] = False
        found.append((row, col, rows, cols))
    return found
