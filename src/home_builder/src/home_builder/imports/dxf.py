"""Plans from DXF drawings: pairs of parallel lines are walls, gaps in them doors."""

import math
import re
from pathlib import Path
from typing import Any, Callable, Iterator, List, Optional, Sequence, Tuple

import ezdxf
import numpy as np
from ezdxf import recover, units
from shapely.geometry import LineString, MultiLineString

from home_builder.errors import ImportPlanError
from home_builder.imports.joints import join_walls, rounded
from home_builder.plan.model import DOOR, WINDOW, HomePlan, Point, Wall
from home_builder.standing import free_start
from planar import SettingsError

# Names of layers and blocks in several languages.
WALL_NAMES = re.compile(r"wall|wand|waende|mur|pared|muro|parede|duvar|vegg", re.IGNORECASE)
WINDOW_NAMES = re.compile(r"window|glaz|fenster|fenetre|ventana|janela|finestr", re.IGNORECASE)
# Distance between the two lines of a wall, and their shortest common length [m].
THICKNESS, MIN_OVERLAP = (0.05, 0.6), 0.2
# Thickness of walls that are drawn as one line, shortest such wall, uncertainty of ends [m].
SINGLE, MIN_SINGLE, SLACK = 0.1, 0.3, 0.02
# Most lines, and the deepest nesting of blocks.
MAX_LINES, MAX_DEPTH = 20_000, 8
Segment = Tuple[Point, Point]
# First and last distance along a line [m].
Interval = Tuple[float, float]


def import_dxf(path: Path, scale: Optional[float] = None) -> HomePlan:
    """Make a plan of a DXF drawing.

    Args:
        path: Drawing; its walls are on layers with a name such as ``A-WALL``, or all that it has.
        scale: Size of a unit [m]; None for the units that the drawing states.

    Raises:
        ImportPlanError: The drawing cannot be read, states no units, or has no walls.
    """
    entities, factor = _drawing(path, scale)
    segments = _wall_segments(entities, factor)
    if len(segments) > MAX_LINES:
        raise ImportPlanError(f"{path}: {len(segments)} lines are more than {MAX_LINES}")
    windows = MultiLineString(
        [list(each) for each in _segments([e for e in entities if WINDOW_NAMES.search(e.dxf.layer)], factor)]
    )
    walls = paired_walls(segments) or _single_walls(segments)
    joined = tuple(map(rounded, join_walls(walls, SLACK, _gaps(windows))))
    if not joined:
        raise ImportPlanError(
            f"{path}: no walls were found with the unit of {factor:g} m; they are pairs of parallel lines, "
            f"{THICKNESS[0]:g} to {THICKNESS[1]:g} m apart, on a layer named wall; --scale sets another unit"
        )
    plan = HomePlan(path.stem, joined)
    try:
        return HomePlan(path.stem, joined, start=free_start(plan))
    except SettingsError as error:
        raise ImportPlanError(
            f"{path}: {error}; with the unit of {factor:g} m; --scale sets another"
        ) from None


def drawn_segments(path: Path, scale: Optional[float] = None) -> List[Segment]:
    """Return the lines that may be faces of walls [m]. Arguments and exceptions are those of import_dxf."""
    return _wall_segments(*_drawing(path, scale))


def _drawing(path: Path, scale: Optional[float]) -> Tuple[List[Any], float]:
    """Return lines and polylines of a drawing, and the size of its unit [m]."""
    document = _read(path)
    factor = _unit(document, path) if scale is None else scale
    return list(_entities(document.modelspace())), factor


def _wall_segments(entities: Sequence[Any], factor: float) -> List[Segment]:
    """Return the straight lines on layers of walls, or all if there is no such layer [m]."""
    on_wall_layers = [entity for entity in entities if WALL_NAMES.search(entity.dxf.layer)]
    return list(_segments(on_wall_layers or entities, factor))


def _read(path: Path) -> Any:
    try:
        document, _ = recover.readfile(str(path))
    except (OSError, ezdxf.DXFError, UnicodeError, ValueError) as error:
        raise ImportPlanError(f"{path}: not a readable DXF file ({error})") from None
    return document


def _unit(document: Any, path: Path) -> float:
    if not document.units:
        raise ImportPlanError(
            f"{path}: the drawing states no units; give --scale, such as 0.001 for millimetres"
        )
    unit = units.InsertUnits(document.units)
    return float(units.conversion_factor(unit, units.InsertUnits.Meters))


def _entities(layout: Any, depth: int = 0) -> Iterator[Any]:
    """Yield lines and polylines, also those of blocks."""
    for entity in layout:
        kind = entity.dxftype()
        if kind in ("LINE", "LWPOLYLINE", "POLYLINE"):
            yield entity
        elif kind == "INSERT" and depth < MAX_DEPTH:
            for part in _entities(entity.virtual_entities(), depth + 1):
                if WINDOW_NAMES.search(entity.dxf.name):
                    part.dxf.layer = entity.dxf.name
                yield part


def _segments(entities: Sequence[Any], factor: float) -> Iterator[Segment]:
    """Yield the straight segments of entities [m]."""
    for entity in entities:
        if entity.dxftype() == "LINE":
            points = [entity.dxf.start, entity.dxf.end]
        elif entity.dxftype() == "LWPOLYLINE":
            points = list(entity.vertices_in_wcs())
            points += points[:1] if entity.closed else []
        else:
            points = list(entity.points())
            points += points[:1] if entity.is_closed else []
        corners = [(float(point[0]) * factor, float(point[1]) * factor) for point in points]
        yield from ((a, b) for a, b in zip(corners, corners[1:]) if math.dist(a, b) > 1e-6)


def paired_walls(segments: Sequence[Segment]) -> List[Wall]:
    """Return a wall between each pair of parallel lines that are as far apart as the faces of a wall.

    Pairs that are closer come first; what a line has in common with one partner is used up.

    Args:
        segments: Straight lines [m].
    """
    lines = np.array(segments, dtype=float).reshape(-1, 4)
    lengths = np.hypot(*(lines[:, 2:] - lines[:, :2]).T)
    lines, lengths = lines[lengths >= THICKNESS[0]], lengths[lengths >= THICKNESS[0]]
    free = [[(0.0, length)] for length in lengths.tolist()]
    walls = []
    for _, one, other in sorted(_parallel_pairs(lines)):
        wall = _between(lines, one, other, free)
        walls += [] if wall is None else [wall]
    return walls


def _parallel_pairs(lines: np.ndarray) -> Iterator[Tuple[float, int, int]]:
    """Yield distance and numbers of parallel lines that can be the faces of a wall."""
    directions = lines[:, 2:] - lines[:, :2]
    directions /= np.maximum(np.hypot(*directions.T)[:, None], 1e-12)
    for one in range(len(lines)):
        others = np.arange(one + 1, len(lines))
        turn = directions[one, 0] * directions[others, 1] - directions[one, 1] * directions[others, 0]
        offset = lines[others, :2] - lines[one, :2]
        across = abs(offset[:, 1] * directions[one, 0] - offset[:, 0] * directions[one, 1])
        fits = (abs(turn) < 0.02) & (across >= THICKNESS[0]) & (across <= THICKNESS[1])
        yield from ((float(across[each]), one, int(others[each])) for each in np.flatnonzero(fits))


def _between(lines: np.ndarray, one: int, other: int, free: List[List[Interval]]) -> Optional[Wall]:
    """Return the wall where two lines run beside each other, and use that up; None if it is too short."""
    start, end = lines[one, :2], lines[one, 2:]
    length = math.dist(start, end)
    along = (end - start) / length
    normal = np.array([-along[1], along[0]])
    ends = [float((point - start) @ along) for point in (lines[other, :2], lines[other, 2:])]
    across = float((lines[other, :2] - start) @ normal)
    common = (max(0.0, min(ends)), min(length, max(ends)))
    of_one = _longest_common(free[one], common)
    if of_one is None:
        return None
    shift, sign = ends[0], math.copysign(1.0, ends[1] - ends[0])
    in_other = sorted((each - shift) * sign for each in of_one)
    of_both = _longest_common(free[other], (in_other[0], in_other[1]))
    if of_both is None:
        return None
    used = sorted(each * sign + shift for each in of_both)
    free[one] = _without(free[one], (used[0], used[1]))
    free[other] = _without(free[other], of_both)
    first, last = (start + along * each + normal * across / 2.0 for each in used)
    return Wall(tuple(first.tolist()), tuple(last.tolist()), abs(across))


def _longest_common(pieces: List[Interval], wanted: Interval) -> Optional[Interval]:
    """Return the longest part of an interval that is free; None if it is shorter than a wall."""
    parts = [(max(a, wanted[0]), min(b, wanted[1])) for a, b in pieces]
    best = max(parts, key=lambda part: part[1] - part[0], default=(0.0, 0.0))
    return best if best[1] - best[0] >= MIN_OVERLAP else None


def _without(pieces: List[Interval], used: Interval) -> List[Interval]:
    rest = [part for a, b in pieces for part in ((a, min(b, used[0])), (max(a, used[1]), b))]
    return [(a, b) for a, b in rest if b - a > 1e-6]


def _single_walls(segments: Sequence[Segment]) -> List[Wall]:
    return [Wall(a, b, SINGLE) for a, b in segments if math.dist(a, b) >= MIN_SINGLE]


def _gaps(windows: MultiLineString) -> Callable[[Point, Point, float], str]:
    """Return the judge of gaps: one with a window drawn in it is a window, others are doors."""

    def kind(start: Point, end: Point, thickness: float) -> str:
        middle = LineString([start, end]).interpolate(0.5, normalized=True)
        return WINDOW if not windows.is_empty and windows.distance(middle) <= thickness else DOOR

    return kind
