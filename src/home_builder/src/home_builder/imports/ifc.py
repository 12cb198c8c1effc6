"""Plans from IFC models: walls of one floor with their openings, and furniture."""

import math
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import numpy as np
import shapely
from shapely.geometry import MultiPoint, Polygon

from home_builder.errors import ImportPlanError
from home_builder.imports.joints import join_walls, rounded
from home_builder.imports.outlines import piece_of
from home_builder.plan.model import DOOR, WINDOW, FurniturePiece, HomePlan, Opening, Room, Wall
from home_builder.standing import free_start
from planar import SettingsError

WALL_TYPE, CURTAIN_TYPE, FURNITURE_TYPE = "IfcWall", "IfcCurtainWall", "IfcFurnishingElement"
MAX_BYTES = 200 << 20
# Thickest wall; greatest height of a door's lower edge above the floor; uncertainty of ends [m].
MAX_THICKNESS, MAX_SILL, SLACK = 0.6, 0.25, 0.02
# Share of the walls of the fullest floor that a lower floor needs to be chosen instead.
SHARE_OF_FULLEST = 0.5
# Height up to which the pane of a low window is solid [m].
LOW_PANE = 0.5
# Height of a robot; what is above it is no obstacle [m].
ROBOT_HEIGHT = 0.6


@dataclass(frozen=True, eq=False)
class Solid:
    """The corners of a product's geometry.

    Attributes:
        points: Corners, (N, 3), in the world [m].
    """

    points: np.ndarray

    @property
    def footprint(self) -> Polygon:
        """Smallest rectangle around its corners from above."""
        return shapely.minimum_rotated_rectangle(MultiPoint(self.points[:, :2]))

    @property
    def heights(self) -> Tuple[float, float]:
        """Lowest and highest point [m]."""
        return float(self.points[:, 2].min()), float(self.points[:, 2].max())


def import_ifc(path: Path) -> HomePlan:
    """Make a plan of the lowest floor of an IFC model that has most of the walls.

    Raises:
        ImportPlanError: The file cannot be read, or has no walls.
    """
    model = _open(path)
    walls = walls_of_floor(model)
    solids = {wall.id(): _solid(wall) for wall in walls}
    level = _level([solid for solid in solids.values() if solid is not None])
    found: List[Wall] = []
    furniture: List[FurniturePiece] = []
    for element in walls:
        solid = solids[element.id()]
        if solid is None:
            continue
        wall = _wall(solid, level)
        if wall is not None:
            found.append(_with_openings(wall, element, level))
        elif isinstance(solid.footprint, Polygon) and solid.heights[0] < level + ROBOT_HEIGHT:
            furniture.append(piece_of(solid.footprint, solid.heights[1] - level))
    if not found:
        raise ImportPlanError(f"{path}: no walls with a geometry were found in this IFC model")
    furniture += _furniture(model, level)
    joined = _joined(found)
    plan = HomePlan(path.stem, joined, tuple(furniture), tuple(_rooms(model, _floor_with_walls(model))))
    try:
        return replace(plan, start=free_start(plan))
    except SettingsError as error:
        raise ImportPlanError(f"{path}: {error}") from None


def walls_of_floor(model: Any) -> List[Any]:
    """Return the walls of the lowest floor of an IFC model that has most of the walls."""
    floor = _floor_with_walls(model)
    walls = [*model.by_type(WALL_TYPE), *model.by_type(CURTAIN_TYPE)]
    return [wall for wall in walls if floor is None or _floor_of(wall) == floor]


def _open(path: Path) -> Any:
    if path.stat().st_size > MAX_BYTES:
        raise ImportPlanError(f"{path}: larger than {MAX_BYTES >> 20} MB")
    try:
        return ifcopenshell.open(str(path))
    except Exception as error:  # of the parser: RuntimeError, ifcopenshell.Error, OSError
        reason = str(error).strip().partition("\n")[0] or type(error).__name__
        raise ImportPlanError(f"{path}: not a readable IFC file ({reason})") from None


def _floor_of(element: Any) -> Optional[int]:
    container = ifcopenshell.util.element.get_container(element)
    return None if container is None else container.id()


def _floor_with_walls(model: Any) -> Optional[int]:
    """Return the id of the lowest floor that has about as many walls as any; None without floors."""
    counts = Counter(filter(None, map(_floor_of, model.by_type(WALL_TYPE))))
    if not counts:
        return None
    enough = SHARE_OF_FULLEST * max(counts.values())
    floors = [number for number, count in counts.items() if count >= enough]
    return min(floors, key=lambda number: getattr(model.by_id(number), "Elevation", None) or 0.0)


def _geometry_settings() -> Any:
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    settings.set("disable-opening-subtractions", True)
    return settings


def _solid(element: Any) -> Optional[Solid]:
    """Return the geometry of a product, or of its parts; None if it has none that can be made."""
    try:
        shape: Any = ifcopenshell.geom.create_shape(_geometry_settings(), element)
    except RuntimeError:
        parts = [_solid(part) for part in ifcopenshell.util.element.get_parts(element)]
        solids = [part for part in parts if part is not None]
        return Solid(np.vstack([part.points for part in solids])) if solids else None
    points = np.array(shape.geometry.verts, dtype=float).reshape(-1, 3)
    return Solid(points) if len(points) >= 4 and np.isfinite(points).all() else None


def _level(solids: List[Solid]) -> float:
    """Return the height of the floor: where most walls begin [m]."""
    bottoms = [round(solid.heights[0], 2) for solid in solids]
    return float(Counter(bottoms).most_common(1)[0][0]) if bottoms else 0.0


def _wall(solid: Solid, level: float) -> Optional[Wall]:
    """Return a straight wall that stands on the floor; None for other shapes."""
    rectangle = solid.footprint
    bottom, top = solid.heights
    if not isinstance(rectangle, Polygon) or bottom > level + ROBOT_HEIGHT:
        return None
    corners = np.asarray(rectangle.exterior.coords)[:4]
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    first = int(np.argmax(sides[:2]))
    if sides[1 - first] > MAX_THICKNESS:
        return None
    start = (corners[first] + corners[(first + 3) % 4]) / 2.0
    end = (corners[first + 1] + corners[(first + 2) % 4]) / 2.0
    return Wall(tuple(start.tolist()), tuple(end.tolist()), float(sides[1 - first]), top - level)


def _with_openings(wall: Wall, element: Any, level: float) -> Wall:
    openings = []
    for relation in getattr(element, "HasOpenings", ()):
        solid = _solid(relation.RelatedOpeningElement)
        if solid is not None:
            fillings = getattr(relation.RelatedOpeningElement, "HasFillings", ())
            is_glazed = any(filling.RelatedBuildingElement.is_a("IfcWindow") for filling in fillings)
            opening = _opening(wall, solid, level, is_glazed)
            openings += [] if opening is None else [opening]
    ordered = sorted(openings, key=lambda each: each.first)
    separate = [
        each for index, each in enumerate(ordered) if index == 0 or each.first >= ordered[index - 1].last
    ]
    return Wall(wall.start, wall.end, wall.thickness, wall.height, tuple(separate))


def _opening(wall: Wall, solid: Solid, level: float, is_glazed: bool) -> Optional[Opening]:
    """Return the part of an opening that lies in the wall; None if that is less than a hand's width.

    The pane of a low window stands as a parapet, since the robot cannot pass it.
    """
    along = (solid.points[:, :2] - wall.start) @ (math.cos(wall.yaw), math.sin(wall.yaw))
    first, last = max(float(along.min()), 0.0), min(float(along.max()), wall.length)
    bottom, top = (each - level for each in solid.heights)
    bottom, top = max(bottom, 0.0), min(top, wall.height)
    if last - first < 0.1 or top - bottom < 0.1:
        return None
    kind = WINDOW if is_glazed or bottom > MAX_SILL else DOOR
    bottom = 0.0 if kind == DOOR else min(max(bottom, LOW_PANE), top - 0.05)
    values = ((first + last) / 2.0, last - first, bottom, top)
    return Opening(kind, *(round(value, 4) for value in values))


def _joined(walls: List[Wall]) -> Tuple[Wall, ...]:
    """Close corners; gaps stay gaps, as doors are known."""
    return tuple(map(rounded, join_walls(walls, SLACK, lambda start, end, thickness: "")))


def _furniture(model: Any, level: float) -> Iterator[FurniturePiece]:
    for element in model.by_type(FURNITURE_TYPE):
        solid = _solid(element)
        if solid is None or not level - 0.1 <= solid.heights[0] < level + ROBOT_HEIGHT:
            continue
        if isinstance(solid.footprint, Polygon) and solid.footprint.area > 0.01:
            yield piece_of(solid.footprint, round(solid.heights[1] - level, 4))


def _rooms(model: Any, floor: Optional[int]) -> Iterator[Room]:
    """Names of spaces, each once."""
    names: Dict[str, int] = {}
    for space in model.by_type("IfcSpace"):
        parent = ifcopenshell.util.element.get_aggregate(space)
        solid = _solid(space) if floor is None or parent is None or parent.id() == floor else None
        if solid is None:
            continue
        name = str(space.LongName or space.Name or "room").strip().lower() or "room"
        names[name] = names.get(name, 0) + 1
        middle = MultiPoint(solid.points[:, :2]).convex_hull.representative_point()
        unique = name if names[name] == 1 else f"{name} {names[name]}"
        yield Room(unique, round(middle.x, 3), round(middle.y, 3))
