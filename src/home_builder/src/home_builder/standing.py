"""Where a robot can stand in a home: the places of rooms and furniture, pick-up and drop-off."""

import math
from dataclasses import dataclass
from typing import Dict, List, Optional, Tuple

import numpy as np
import shapely
from scipy.ndimage import label
from shapely.ops import polylabel

from home_builder.palette import OUTLINE
from home_builder.plan.frames import plan_in_world
from home_builder.plan.geometry import furniture_polygon, room_faces, wall_polygons
from home_builder.plan.model import HomePlan, Place
from planar import FREE, OccupancyGrid, SettingsError
from planar.geometry.distance_field import distance_field

# Distances from the robot's centre to obstacles [m]: on a path; where it stops, at best and at least.
PASSAGE, COMFORT, LEAST = 0.25, 0.8, 0.35
# Farthest from a piece of furniture that a robot stops in front of it [m].
REACH = 1.2
# Shortest way of a delivery, as the crow flies [m].
MIN_DISTANCE = 1.0
# Clearance at a start that is chosen, and the grid on which it lies [m].
START_CLEARANCE, CELL = 0.4, 0.05
PICKUP, DROPOFF = "pickup", "dropoff"


@dataclass(frozen=True, eq=False)
class StandingRoom:
    """Where the robot can stand and get to from its start.

    Attributes:
        points_xy: Centres of the cells, (N, 2), in the map [m].
        clearance: Distance of each to the nearest obstacle, (N,) [m].
    """

    points_xy: np.ndarray
    clearance: np.ndarray

    @classmethod
    def of_map(cls, grid: OccupancyGrid) -> "StandingRoom":
        """Find where a robot that starts at the origin of a map can stand.

        Raises:
            SettingsError: It cannot leave its start.
        """
        clearance = distance_field(grid.cells != FREE, grid.resolution)
        regions, _ = label(clearance > PASSAGE)
        ((row, col),) = grid.cells_of([[0.0, 0.0]])
        if not regions[row, col]:
            raise SettingsError("the start is too close to a wall or furniture: the robot cannot leave it")
        cells = np.argwhere((regions == regions[row, col]) & (clearance > LEAST))
        return cls(grid.points_of(cells), clearance[tuple(cells.T)])

    def inside(self, polygon) -> "StandingRoom":
        """Return the part that lies in a polygon."""
        chosen = shapely.contains_xy(polygon, self.points_xy)
        return StandingRoom(self.points_xy[chosen], self.clearance[chosen])

    def middle(self) -> Optional[Tuple[float, float]]:
        """Return the point with the most room around it, near the centre; None if there is none."""
        if not len(self.points_xy):
            return None
        off_centre = np.hypot(*(self.points_xy - self.points_xy.mean(axis=0)).T)
        best = np.argmax(np.minimum(self.clearance, COMFORT) - 0.1 * off_centre)
        x, y = self.points_xy[best].tolist()
        return x, y


def all_places(plan: HomePlan, grid: OccupancyGrid) -> Dict[str, Place]:
    """Return the places of a home by name: of the plan, of rooms and furniture, pick-up and drop-off.

    Args:
        plan: The plan.
        grid: Its map.

    Returns:
        Places in the frame of the map, whose origin is the start.

    Raises:
        SettingsError: There are fewer than two places.
    """
    plan = plan_in_world(plan)
    solids = shapely.union_all([*wall_polygons(plan.walls), *map(furniture_polygon, plan.furniture)])
    # Outside of all that is solid there is nothing to localize by.
    reached = StandingRoom.of_map(grid)
    standing = reached.inside(solids.convex_hull)
    if not len(standing.points_xy):  # the robot starts outside of a closed building
        standing = reached
    places = {each.name: each for each in plan.places}
    rooms = _room_places(plan, standing)
    for place in (*rooms, *_furniture_places(plan, standing)):
        places.setdefault(place.name, place)
    if PICKUP not in places or DROPOFF not in places:
        for name, (x, y) in zip((PICKUP, DROPOFF), _ends(standing, rooms)):
            places.setdefault(name, Place(name, x, y))
    return places


def _room_places(plan: HomePlan, standing: StandingRoom) -> List[Place]:
    places = []
    for face in room_faces(plan):
        middle = standing.inside(face.polygon).middle()
        if middle is not None:
            places.append(Place(face.name, *middle))
    return places


def _furniture_places(plan: HomePlan, standing: StandingRoom) -> List[Place]:
    """Places in front of furniture: of each piece with a name, and of each kind that occurs once."""
    kinds = [piece.kind for piece in plan.furniture]
    places = []
    for piece in plan.furniture:
        is_only_one = piece.kind != OUTLINE and kinds.count(piece.kind) == 1
        name = piece.name or (piece.kind if is_only_one else "")
        if not name:
            continue
        polygon = furniture_polygon(piece)
        distances = shapely.distance(polygon, shapely.points(standing.points_xy))
        if not len(distances) or distances.min() > REACH:
            continue
        x, y = standing.points_xy[
            np.argmin(distances + 0.2 * _off_axis(standing.points_xy, polygon))
        ].tolist()
        yaw = math.atan2(polygon.centroid.y - y, polygon.centroid.x - x)
        places.append(Place(name, x, y, yaw))
    return places


def _off_axis(points_xy: np.ndarray, polygon) -> np.ndarray:
    """Return how far points (N, 2) are from the middle of a piece of furniture [m]."""
    return np.hypot(*(points_xy - np.array(polygon.centroid.coords[0])).T)


def _ends(standing: StandingRoom, rooms: List[Place]) -> List[Tuple[float, float]]:
    """Return pick-up and drop-off: the room farthest from the start, and that farthest from it."""
    points = np.array([(room.x, room.y) for room in rooms]).reshape(-1, 2)
    if len(points) < 2 or np.ptp(points, axis=0).max() < MIN_DISTANCE:
        points = standing.points_xy
    if not len(points):
        raise SettingsError("the home has no room in which the robot can stand: all of it is too narrow")
    first = points[np.argmax(np.hypot(*points.T))]
    last = points[np.argmax(np.hypot(*(points - first).T))]
    if math.dist(first, last) < MIN_DISTANCE:
        raise SettingsError("the home is too small for a delivery: no two places are 1 m apart")
    return [tuple(first.tolist()), tuple(last.tolist())]


def free_start(plan: HomePlan) -> Tuple[float, float]:
    """Return where a robot can start: the middle of the largest room, or of what the walls surround [m].

    Args:
        plan: HomePlan without a start.

    Raises:
        SettingsError: There is no room for the robot.
    """
    solids = shapely.union_all([*wall_polygons(plan.walls), *map(furniture_polygon, plan.furniture)])
    faces = [face.polygon for face in room_faces(plan)] or [solids.convex_hull]
    for face in faces:
        free = face.difference(solids)
        largest = max(getattr(free, "geoms", [free]), key=lambda part: part.area)
        if largest.area < START_CLEARANCE**2:
            continue
        middle = polylabel(largest, CELL)
        if largest.boundary.distance(middle) > START_CLEARANCE:
            x, y = (round(round(each / CELL) * CELL, 4) for each in (middle.x, middle.y))
            return x, y
    raise SettingsError("the walls leave no room in which the robot fits")
