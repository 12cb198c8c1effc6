"""Joins walls: ends move onto the walls they meet, gaps become doors and windows."""

import math
from dataclasses import replace
from typing import Callable, List, Optional, Sequence, Tuple

import numpy as np

from home_builder.plan.model import DOOR, EDGES, WINDOW, Opening, Wall

# Widths of doors, greatest width of a window, and of a door between the end of a wall and another wall [m].
DOORS, MAX_WINDOW, MAX_END_DOOR = (0.5, 1.4), 3.0, 1.25
# Largest angle between walls of one line [rad].
SAME_DIRECTION = math.radians(3.0)

# Decides on the gap between two points of a line: ``door``, ``window``, or empty if it is no gap. The third
# argument is the thickness of the wall.
GapKind = Callable[[Tuple[float, float], Tuple[float, float], float], str]


def always_door(start: Tuple[float, float], end: Tuple[float, float], thickness: float) -> str:
    """Take every gap for a door; for drawings, in which a gap is nothing else."""
    return DOOR


def join_walls(walls: Sequence[Wall], slack: float, gap_kind: GapKind = always_door) -> List[Wall]:
    """Join the walls of an imported plan.

    Args:
        walls: Walls without openings.
        slack: Uncertainty of their ends [m]: a cell of a map.
        gap_kind: Decides on gaps.

    Returns:
        Walls whose ends are on the centre lines of the walls they meet, with doors and windows.
    """
    joined = [_snapped(wall, walls, slack) for wall in walls]
    joined = [wall for wall in joined if wall.length > 2.0 * slack]
    joined = _merged_over_gaps(joined, slack, gap_kind)
    return [_with_end_door(index, joined, slack, gap_kind) for index in range(len(joined))]


def _snapped(wall: Wall, walls: Sequence[Wall], slack: float) -> Wall:
    """Move the ends of a wall onto the centre lines of walls that they lie in."""
    start, end = (_snapped_end(wall, each, walls, slack) for each in (wall.start, wall.end))
    return replace(wall, start=start, end=end)


def _snapped_end(
    wall: Wall, end: Tuple[float, float], walls: Sequence[Wall], slack: float
) -> Tuple[float, float]:
    for other in walls:
        if other is wall or abs(math.sin(other.yaw - wall.yaw)) < 0.3:
            continue
        met = _crossing(wall, other)
        along, _ = _local(other, *met)
        reach = wall.thickness / 2.0 + slack
        is_on_other = -reach <= along <= other.length + reach
        # As far as the wall reaches into the other one, or one cell before it.
        if is_on_other and math.dist(met, end) <= other.thickness / 2.0 + 1.5 * slack:
            return met
    return end


def _crossing(wall: Wall, other: Wall) -> Tuple[float, float]:
    """Return the point where the centre lines of two walls that are not parallel meet."""
    cos, sin = math.cos(wall.yaw), math.sin(wall.yaw)
    along, across = _local(other, *wall.start)
    turn = wall.yaw - other.yaw
    distance = -across / math.sin(turn)
    return wall.start[0] + distance * cos, wall.start[1] + distance * sin


def _local(wall: Wall, x: float, y: float) -> Tuple[float, float]:
    """Return a point as distance along the wall from its start, and across it to the left."""
    dx, dy = x - wall.start[0], y - wall.start[1]
    cos, sin = math.cos(wall.yaw), math.sin(wall.yaw)
    return dx * cos + dy * sin, dy * cos - dx * sin


def _merged_over_gaps(walls: List[Wall], slack: float, gap_kind: GapKind) -> List[Wall]:
    """Merge walls of one line over the gaps between them."""
    walls, index = list(walls), 0
    while index < len(walls):
        merged = _merged_with_next(index, walls, slack, gap_kind)
        if merged is None:
            index += 1
            continue
        other, wall = merged
        walls[index] = wall
        del walls[other]
        index -= other < index
    return walls


def _merged_with_next(
    index: int, walls: Sequence[Wall], slack: float, gap_kind: GapKind
) -> Optional[Tuple[int, Wall]]:
    """Return the nearest wall that goes on behind the end of a wall, and the two as one; None without it."""
    wall, best = walls[index], None
    for number, other in enumerate(walls):
        if number == index or abs(math.sin(other.yaw - wall.yaw)) > math.sin(SAME_DIRECTION):
            continue
        if abs(other.thickness - wall.thickness) > 2.0 * slack + 0.02:
            continue
        ends = sorted(_local(wall, *end) for end in (other.start, other.end))
        is_in_line = all(abs(across) <= 1.5 * slack + 0.01 for _, across in ends)
        gap = ends[0][0] - wall.length
        goes_on = ends[1][0] > wall.length + slack
        if is_in_line and goes_on and -slack <= gap <= MAX_WINDOW and (best is None or gap < best[1]):
            best = (number, gap, ends[1][0])
    if best is None:
        return None
    number, gap, last = best
    opening = _opening(wall, gap, slack, gap_kind)
    if opening is None:
        return None
    return number, _continued(wall, walls[number], last, opening)


def _opening(wall: Wall, gap: float, slack: float, gap_kind: GapKind) -> Optional[Tuple[Opening, ...]]:
    """Return the opening in the gap behind a wall, none for walls that touch; None if they stay apart."""
    if gap <= 2.0 * slack:
        return ()
    kind = gap_kind(wall.end, wall.point_at(wall.length + gap), wall.thickness)
    fits = kind == WINDOW or (kind == DOOR and DOORS[0] <= gap <= DOORS[1])
    if not fits:
        return None
    return (Opening(kind, wall.length + gap / 2.0, gap, *EDGES[kind]),)


def _continued(wall: Wall, other: Wall, last: float, openings: Tuple[Opening, ...]) -> Wall:
    """Return a wall that ends where ``other`` ends, with the openings of both."""
    is_reversed = math.cos(other.yaw - wall.yaw) < 0.0
    end = other.start if is_reversed else other.end
    first = last - other.length
    moved = [
        replace(each, at=first + (other.length - each.at if is_reversed else each.at))
        for each in other.openings
    ]
    return replace(wall, end=end, openings=(*wall.openings, *openings, *moved))


def _with_end_door(index: int, walls: Sequence[Wall], slack: float, gap_kind: GapKind) -> Wall:
    """Continue the ends of a wall up to a wall across, if the gap between them can be a door."""
    wall = walls[index]
    for _ in range(2):
        wall = _reversed(wall)
        width = _gap_to_wall_across(wall, index, walls)
        if width is None or not DOORS[0] <= width <= MAX_END_DOOR:
            continue
        far = wall.point_at(wall.length + width)
        if gap_kind(wall.end, far, wall.thickness) == DOOR:
            door = Opening(DOOR, wall.length + width / 2.0, width)
            wall = replace(wall, end=far, openings=(*wall.openings, door))
    return wall


def _reversed(wall: Wall) -> Wall:
    openings = tuple(replace(each, at=wall.length - each.at) for each in reversed(wall.openings))
    return replace(wall, start=wall.end, end=wall.start, openings=openings)


def _gap_to_wall_across(wall: Wall, index: int, walls: Sequence[Wall]) -> Optional[float]:
    """Return the distance from a wall's end to the face of the nearest wall across it; None without one."""
    nearest = None
    for number, other in enumerate(walls):
        if number == index or abs(math.sin(other.yaw - wall.yaw)) < 0.7:
            continue
        met = _crossing(wall, other)
        along, _ = _local(other, *met)
        distance = _local(wall, *met)[0] - wall.length
        if not -0.05 <= along <= other.length + 0.05 or distance < -other.thickness:
            continue
        gap = distance - other.thickness / 2.0
        if nearest is None or gap < nearest:
            nearest = gap
    return nearest


def rounded(wall: Wall, digits: int = 4) -> Wall:
    """Return a wall with rounded coordinates, for a file that people read."""
    ends = [tuple(np.round(end, digits).tolist()) for end in (wall.start, wall.end)]
    openings = tuple(
        replace(each, at=round(float(each.at), digits), width=round(float(each.width), digits))
        for each in wall.openings
    )
    return replace(
        wall, start=ends[0], end=ends[1], thickness=round(wall.thickness, digits), openings=openings
    )
