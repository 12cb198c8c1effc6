"""Random reachable poses in a home, and boxes that are not in the map."""

import math
from typing import List

import numpy as np

from move_base_lite import Navigator, NavigatorSettings, PlanningError
from move_base_lite.costmap import LayeredCostmap
from planar import FREE, OccupancyGrid, Pose2

BOX_SIZE = (0.35, 0.35, 0.5)
BOX_CLEARANCE = 1.0


def random_poses(settings: NavigatorSettings, grid: OccupancyGrid, rng, count: int) -> List[Pose2]:
    """Return random poses that the robot can reach from the map's origin."""
    costmap = LayeredCostmap(settings.global_costmap, grid)
    navigator = Navigator(settings, grid)
    poses: List[Pose2] = []
    free = np.argwhere((costmap.map_costs < 128) & (grid.cells == FREE))
    while len(poses) < count:
        x, y = grid.points_of(free[rng.integers(len(free), size=1)])[0]
        pose = Pose2(float(x), float(y), float(rng.uniform(-math.pi, math.pi)))
        if _is_connected(navigator, pose):
            poses.append(pose)
    return poses


def _is_connected(navigator: Navigator, pose: Pose2) -> bool:
    try:
        return len(navigator.make_plan(Pose2(), pose)) > 0
    except PlanningError:
        return False


def add_box(simulation, name, settings, grid, rng, keep_free) -> None:
    """Add a box that is not in the map, away from ``keep_free`` and from narrow passages."""
    costmap = LayeredCostmap(settings.global_costmap, grid)
    open_cells = np.argwhere(costmap.map_costs == 0)
    while True:
        x, y = grid.points_of(open_cells[rng.integers(len(open_cells), size=1)])[0]
        box = Pose2(float(x), float(y), float(rng.uniform(-math.pi, math.pi)))
        if all(box.distance_to(pose) > BOX_CLEARANCE for pose in keep_free):
            simulation.add_box(name, BOX_SIZE, box)
            return
