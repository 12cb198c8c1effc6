"""Where furniture tops can be looked at from, what each view shows, and how far views are apart."""

import math
from functools import cached_property
from typing import Dict, List, Optional, Tuple

import numpy as np

from pick_objects.mission import REACH
from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, SettingsError
from planar.detection import DetectionModel
from planar.geometry.distance_field import distance_field
from planar.geometry.grid_paths import GridPaths
from planar.geometry.ray_casting import cast_rays
from planar.maps.semantic_map import FurnitureTop, SemanticMap

# Distance of a standing robot's centre to obstacles, and of the candidate positions from each other [m].
STANDING_CLEARANCE, SPACING = 0.4, 0.4
# Headings that are considered at each candidate position, and the most views that are kept.
HEADINGS, MAX_VIEWS = 12, 80
# Share of the tops that a further view must show to be kept.
MIN_VIEW_GAIN = 2e-3
# Mean speed of drives [m/s], and time to start, turn, stop and look [s].
SPEED, STOP_SECONDS = 0.3, 5.0


class SearchArea:
    """Views of the furniture tops of a home; computed once for all searches.

    Args:
        grid: Map of the home.
        semantic_map: Furniture and priors.
        model: Model of the detector.

    Attributes:
        semantic_map: As given.
        tops: Furniture tops in their order.
        points_xy: Points (N, 2) of all tops in the map [m].
        top_of_point: Index of the top of each point (N,).
        paths: Paths on the map.
        views: Standing poses in the map from which tops are seen.
        detection: Probability (V, N) that an object at each point is detected by a look from each view.

    Raises:
        SettingsError: The map lists no furniture.
    """

    def __init__(
        self, grid: OccupancyGrid, semantic_map: SemanticMap, model: DetectionModel = DetectionModel()
    ):
        if not semantic_map.furniture:
            raise SettingsError(f"{semantic_map.source}: has no furniture on which objects could be")
        self.semantic_map = semantic_map
        self.tops: Tuple[FurnitureTop, ...] = tuple(semantic_map.furniture.values())
        points = [top.points_xy() for top in self.tops]
        self.points_xy = np.concatenate(points)
        self.top_of_point = np.repeat(np.arange(len(points)), [len(each) for each in points])
        self._grid, self._model = grid, model

    # Computed when a search begins: most missions have none.
    @cached_property
    def paths(self) -> GridPaths:
        return GridPaths(self._grid)

    @property
    def views(self) -> Tuple[Pose2, ...]:
        return self._views_and_detection[0]

    @property
    def detection(self) -> np.ndarray:
        return self._views_and_detection[1]

    @cached_property
    def seconds_between_views(self) -> np.ndarray:
        """Time to drive from each view to each, and to look, (V, V) [s]."""
        rows = [self.paths.lengths_from(node)[self._nodes] for node in self._nodes]
        return STOP_SECONDS + np.array(rows).reshape(len(rows), len(rows)) / SPEED

    @cached_property
    def _standing_cells(self) -> np.ndarray:
        clearance = distance_field(self._grid.cells != FREE, self._grid.resolution)
        return np.argwhere(clearance > STANDING_CLEARANCE)

    @cached_property
    def _standing_xy(self) -> np.ndarray:
        cells = self._standing_cells
        return self._grid.points_of(cells) if len(cells) else np.empty((0, 2))

    @cached_property
    def _views_and_detection(self) -> Tuple[Tuple[Pose2, ...], np.ndarray]:
        return self._choose_views(self._grid, self._standing_cells, self._model)

    @cached_property
    def _nodes(self) -> List[int]:
        return [self.paths.node_at(view.x, view.y) for view in self.views]

    def seconds_to_views(self, base_in_map: Pose2) -> np.ndarray:
        """Return the time to drive from a pose to each view, and to look [s], (V,)."""
        return STOP_SECONDS + self._lengths_from(base_in_map)[self._nodes] / SPEED

    def pose_near(self, x: float, y: float, base_in_map: Pose2) -> Optional[Pose2]:
        """Return where a robot stands to pick up an object; None if it cannot come near enough.

        Args:
            x: Position of the object in the map [m].
            y: Position of the object in the map [m].
            base_in_map: Where the robot is now.
        """
        distances = np.hypot(*(self._standing_xy - (x, y)).T)
        lengths = self._lengths_from(base_in_map)
        for index in np.argsort(distances, kind="stable"):
            if distances[index] > REACH:
                return None
            robot_x, robot_y = self._standing_xy[index].tolist()
            if np.isfinite(lengths[self.paths.node_at(robot_x, robot_y)]):
                return Pose2(robot_x, robot_y, math.atan2(y - robot_y, x - robot_x))
        return None

    def _lengths_from(self, pose: Pose2) -> np.ndarray:
        return self.paths.lengths_from(self.paths.node_at(pose.x, pose.y))

    def _choose_views(
        self, grid: OccupancyGrid, cells: np.ndarray, model: DetectionModel
    ) -> Tuple[Tuple[Pose2, ...], np.ndarray]:
        """Return views and what they show: the best of each top, then by what they add to the others."""
        step = max(1, round(SPACING / grid.resolution))
        places_xy = grid.points_of(cells[(cells % step == 0).all(axis=1)]) if len(cells) else cells[:, :2]
        if not len(places_xy):
            return (), np.empty((0, len(self.points_xy)))
        poses, shown = self._candidates(_without_low_tops(grid, self.tops, model), places_xy, model)
        sizes = np.bincount(self.top_of_point)
        weights = 1.0 / (sizes[self.top_of_point] * len(sizes))
        chosen: Dict[int, None] = {}
        for top in range(len(sizes)):
            gains = shown[:, self.top_of_point == top].sum(axis=1)
            if gains.max() > 0.0:
                chosen[int(gains.argmax())] = None
        left = weights * np.prod(1.0 - shown[list(chosen)], axis=0)
        while len(chosen) < max(MAX_VIEWS, len(sizes)):
            gains = shown @ left
            best = int(gains.argmax())
            if gains[best] < MIN_VIEW_GAIN:
                break
            chosen[best] = None
            left = left * (1.0 - shown[best])
        return tuple(poses[index] for index in chosen), shown[list(chosen)].astype(float)

    def _candidates(
        self, walls: OccupancyGrid, places_xy: np.ndarray, model: DetectionModel
    ) -> Tuple[List[Pose2], np.ndarray]:
        """Return poses and their detection probabilities, (P, N)."""
        yaws = np.arange(HEADINGS) * (2.0 * math.pi / HEADINGS)
        poses, shown = [], []
        for x, y in places_xy.tolist():
            offsets = self.points_xy - (x, y)
            ranges, angles = np.hypot(*offsets.T), np.arctan2(offsets[:, 1], offsets[:, 0])
            near = np.flatnonzero(ranges < model.range_max)
            free = cast_rays(walls, Pose2(x, y), angles[near], model.range_max)
            near = near[free >= ranges[near] - model.depth]
            if not len(near):
                continue
            bearings = np.angle(np.exp(1j * (angles[near][None, :] - yaws[:, None])))
            rows = np.zeros((HEADINGS, len(self.points_xy)), dtype=np.float32)
            rows[:, near] = model.probability_at(np.broadcast_to(ranges[near], bearings.shape), bearings)
            poses += [Pose2(x, y, yaw) for yaw in yaws.tolist()]
            shown.append(rows)
        if not shown:
            return [Pose2(*places_xy[0].tolist())], np.zeros((1, len(self.points_xy)), dtype=np.float32)
        return poses, np.concatenate(shown)


def _without_low_tops(
    grid: OccupancyGrid, tops: Tuple[FurnitureTop, ...], model: DetectionModel
) -> OccupancyGrid:
    """Return the map without the furniture over which the camera looks."""
    cells = np.where(grid.cells == OCCUPIED, OCCUPIED, FREE).astype(np.int8)
    rows_cols = np.argwhere(cells == OCCUPIED)
    if not len(rows_cols):
        return OccupancyGrid(cells, grid.resolution, grid.origin)
    points = grid.points_of(rows_cols)
    for top in tops:
        if top.height < model.height:
            local = np.abs(top.pose.inverse().transform_points(points))
            inside = (local <= np.array(top.size) / 2.0 + grid.resolution / 2.0).all(axis=1)
            cells[tuple(rows_cols[inside].T)] = FREE
    return OccupancyGrid(cells, grid.resolution, grid.origin)


def search_area_of(grid: OccupancyGrid, semantic_map: Optional[SemanticMap]) -> Optional[SearchArea]:
    """Return where objects can be searched in a home; None without a semantic map or furniture.

    Args:
        grid: Map of the home.
        semantic_map: Furniture and priors; None if there is none.
    """
    if semantic_map is None or not semantic_map.furniture:
        return None
    return SearchArea(grid, semantic_map)
