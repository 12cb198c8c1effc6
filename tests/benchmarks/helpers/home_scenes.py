"""Random places of a home that a robot can reach, and boxes that its map does not show."""

import math
from typing import List

import numpy as np

from move_base_lite import Navigator, NavigatorSettings, PlanningError
from move_base_lite.costmap import LayeredCostmap
from planar import FREE, OccupancyGrid, Pose2

BOX_SIZE = (0.35, 0.35, 0.5)
BOX_CLEARANCE = 1.0


def places(settings: NavigatorSettings, grid: OccupancyGrid, rng, count: int) -> List[Pose2]:
    """Random poses in the part of the map that the robot can reach from the map's origin."""
    costmap = LayeredCostmap(settings.global_costmap, grid)
    navigator = Navigator(settings, grid)
    places: List[Pose2] = []
    free = np.argwhere((costmap.map_costs < 128) & (grid.cells == FREE))
    while len(places) < count:
        x, y = grid.points_of(free[rng.integers(len(free), size=1)])[0]
        place = Pose2(float(x), float(y), float(rng.uniform(-math.pi, math.pi)))
        if _is_connected(navigator, place):
            places.append(place)
    return places


def _is_connected(navigator: Navigator, place: Pose2) -> bool:
    try:
        return len(navigator.make_plan(Pose2(), place)) > 0
    except PlanningError:
        return False


def add_box(simulation, name, settings, grid, rng, keep_free) -> None:
    """Puts a box that the map does not show somewhere off the ends of the way and off narrow places."""
    costmap = LayeredCostmap(settings.global_costmap, grid)
    open_cells = np.argwhere(costmap.map_costs == 0)
    while True:
        x, y = grid.points_of(open_cells[rng.integers(len(open_cells), size=1)])[0]
        box = Pose2(float(x), float(y), float(rng.uniform(-math.pi, math.pi)))
        if all(box.distance_to(place) > BOX_CLEARANCE for place in keep_free):
            simulation.add_box(name, BOX_SIZE, box)
            return
