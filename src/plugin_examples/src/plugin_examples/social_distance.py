"""A costmap layer that keeps the robot away from walking people (Kirby, Simmons and Forlizzi, 2009).

The cost around each person is a Gaussian, longer in the direction of walking. The layer belongs in the local
costmap.
"""

import math
from dataclasses import dataclass

import numpy as np

from move_base_lite import Layer, LayerSettings
from move_base_lite.costmap import INSCRIBED, CostmapPlacement, LayerContext, Observation
from move_base_lite.costmap.window import NO_CELLS, CellBounds, CostmapWindow, union
from move_base_lite.dynamic_obstacles import NO_DYNAMIC_OBSTACLES, DynamicObstacleTracker
from planar import Pose2
from planar.config.parameters import POSITIVE, at_least, parameter

# Standard deviations at which a Gaussian is cut off, and the cost at its centre, below an obstacle's.
REACH, HIGHEST = 2.0, INSCRIBED - 1


@dataclass(frozen=True)
class SocialDistanceSettings(LayerSettings):
    """Topic of the laser, and size of the costs around a person."""

    topic: str = parameter("scan", "topic of the laser")
    spread: float = parameter(
        0.4, "standard deviation beside and behind a person", "m", POSITIVE, dynamic=2.0
    )
    foresight: float = parameter(
        1.0, "additional standard deviation ahead per m/s of walking speed", "s", at_least(0.0), dynamic=5.0
    )


class SocialDistance(Layer):
    """Costmap layer with a Gaussian around each tracked person.

    Args:
        settings: Topic of the laser, and size of the Gaussians.
        site: Not used.
    """

    Settings = SocialDistanceSettings

    def __init__(self, settings: SocialDistanceSettings, site: LayerContext):
        self._settings = settings
        self._tracker, self._stamp = DynamicObstacleTracker(), 0.0
        self._people, self._bounds = NO_DYNAMIC_OBSTACLES, NO_CELLS

    def add_observation(self, observation: Observation, base_in_frame: Pose2) -> None:
        """Update the tracked people by a scan.

        Args:
            observation: Beams of one sensor; those of other topics are ignored.
            base_in_frame: Robot in the costmap's frame when they were measured.
        """
        if observation.topic == self._settings.topic:
            self._tracker.update(base_in_frame, observation)
            self._stamp = observation.stamp

    def update(self, placement: CostmapPlacement) -> CellBounds:
        """Compute which cells the people of now and of the last update cover."""
        before, self._people, self._bounds = (
            self._bounds,
            self._tracker.obstacles_at(self._stamp),
            NO_CELLS,
        )
        for x, y, along_x, along_y, _ in self._people:
            reach = REACH * self._forward_spread(math.hypot(along_x, along_y))
            self._bounds = union(
                self._bounds, placement.window.cut(placement.window.bounds_around(x, y, reach))
            )
        return union(before, self._bounds)

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds: CellBounds) -> None:
        """Raise costs to the Gaussians' values.

        Args:
            costs: Costs of the layers below, uint8 (rows, cols); changed in place.
            window: Position of the cells.
            bounds: Block of cells to change.
        """
        rows, cols = np.mgrid[bounds.slices]
        if not rows.size:
            return
        x = window.origin_x + (cols + 0.5) * window.resolution
        y = window.origin_y + (rows + 0.5) * window.resolution
        block = costs[bounds.slices]
        for person in self._people:
            added = (HIGHEST * self._cost_share(person, x, y)).astype(np.uint8)
            np.maximum(block, added, out=block, where=block < added)

    def clear_outside(self, bounds: CellBounds, window: CostmapWindow) -> CellBounds:
        """Drop all tracked people, also those within the bounds.

        Returns:
            Block of cells whose costs change.
        """
        before = self._bounds
        self._tracker, self._people, self._bounds = (
            DynamicObstacleTracker(),
            NO_DYNAMIC_OBSTACLES,
            NO_CELLS,
        )
        return before

    def _forward_spread(self, speed: float) -> float:
        return self._settings.spread + self._settings.foresight * speed

    def _cost_share(self, person: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Share of HIGHEST at each cell."""
        middle_x, middle_y, along_x, along_y, _ = person
        speed, heading = math.hypot(along_x, along_y), math.atan2(along_y, along_x)
        ahead = (x - middle_x) * math.cos(heading) + (y - middle_y) * math.sin(heading)
        aside = (y - middle_y) * math.cos(heading) - (x - middle_x) * math.sin(heading)
        spread = np.where(ahead > 0.0, self._forward_spread(speed), self._settings.spread)
        squares = (ahead / spread) ** 2 + (aside / self._settings.spread) ** 2
        return np.where(squares <= REACH**2, np.exp(-0.5 * squares), 0.0)
