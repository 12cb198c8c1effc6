"""How good a map is, compared with the true one."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import binary_closing, find_objects, label
from scipy.spatial import cKDTree

from planar.distance_field import distance_field
from planar.errors import PlanarError
from planar.grid import FREE, OCCUPIED, OccupancyGrid
from planar.pose import Pose2
from planar.ray_casting import cast_rays_from_many

VIEWPOINT_SPACING = 0.25
RAYS = 720
DOUBLING_GAP = 0.30
DOUBLING_LENGTH = 0.30


@dataclass(frozen=True)
class MapScore:
    """``recall``: share of the visible true wall cells that the map has within the tolerance; ``precision``:
    share of the map's wall cells that are true within it; ``doubled_walls``: how many walls it has twice."""

    recall: float
    precision: float
    doubled_walls: int


def score_map(
    grid: OccupancyGrid,
    truth: OccupancyGrid,
    start_in_truth: Pose2 = Pose2(),
    truth_in_map: Pose2 = Pose2(),
    tolerance: float = 0.10,
    robot_radius: float = 0.18,
    sight: float = 10.0,
) -> MapScore:
    """Scores a map against the true one, of any extent and resolution each.

    Counted as visible are walls that a robot of ``robot_radius`` metres could have in ``sight`` metres from
    anywhere it can drive to from ``start_in_truth``. Raises PlanarError if that place is not free.
    """
    mapped_xy = grid.points_of(np.argwhere(grid.cells == OCCUPIED))
    true_xy = truth_in_map.transform_points(truth.points_of(np.argwhere(truth.cells == OCCUPIED)))
    visible_cells = visible_walls(truth, start_in_truth, robot_radius, sight)
    visible_xy = truth_in_map.transform_points(truth.points_of(visible_cells))
    if len(mapped_xy) == 0:
        return MapScore(0.0, 0.0, 0)
    return MapScore(
        recall=_share_near(visible_xy, mapped_xy, tolerance),
        precision=_share_near(mapped_xy, true_xy, tolerance),
        doubled_walls=_count_doubled_walls(grid, truth, truth_in_map, tolerance),
    )


def visible_walls(truth: OccupancyGrid, start: Pose2, robot_radius: float, sight: float) -> np.ndarray:
    """Occupied cells (N, 2) as (row, col) that can be seen from where a robot can drive to from ``start``."""
    clearance = distance_field(truth.cells == OCCUPIED, truth.resolution)
    regions, _ = label((truth.cells == FREE) & (clearance > robot_radius))
    start_cell = truth.cells_of([[start.x, start.y]])
    region = regions[tuple(start_cell[0])] if truth.contains(start_cell)[0] else 0
    if region == 0:
        raise PlanarError(f"a robot cannot stand at ({start.x:g}, {start.y:g}) of the true map")
    step = max(1, round(VIEWPOINT_SPACING / truth.resolution))
    viewpoints = np.argwhere(regions[::step, ::step] == region) * step
    poses = np.column_stack((truth.points_of(viewpoints), np.zeros(len(viewpoints))))
    angles = np.arange(RAYS) * (2.0 * np.pi / RAYS)
    ranges = cast_rays_from_many(truth, poses, angles, sight)
    depths = ranges + 1e-3 * truth.resolution
    ends_xy = poses[:, None, :2] + depths[:, :, None] * np.column_stack((np.cos(angles), np.sin(angles)))
    cells = np.unique(truth.cells_of(ends_xy[ranges < sight]), axis=0)
    cells = cells[truth.contains(cells)]
    return cells[truth.cells[tuple(cells.T)] == OCCUPIED]


def _share_near(points_xy, others_xy, tolerance) -> float:
    distances, _ = cKDTree(others_xy).query(points_xy)
    return float(np.mean(distances <= tolerance + 1e-9))


def _count_doubled_walls(grid, truth, truth_in_map, tolerance) -> int:
    """Long narrow gaps between walls that the truth has not: the same wall, drawn in two places."""
    return sum(_count_false_gaps(grid, truth, truth_in_map, tolerance, across) for across in (0, 1))


def _count_false_gaps(grid, truth, truth_in_map, tolerance, across) -> int:
    gap_cells = np.argwhere(_gaps(grid, across))
    true_gaps_xy = [
        truth_in_map.transform_points(truth.points_of(np.argwhere(_gaps(truth, i)))) for i in (0, 1)
    ]
    if len(gap_cells) and any(map(len, true_gaps_xy)):
        distances, _ = cKDTree(np.vstack(true_gaps_xy)).query(grid.points_of(gap_cells))
        gap_cells = gap_cells[distances > tolerance]
    is_false = np.zeros(grid.cells.shape, dtype=bool)
    is_false[tuple(gap_cells.T)] = True
    gaps, _ = label(is_false, structure=np.ones((3, 3)))
    lengths = [gap[1 - across].stop - gap[1 - across].start for gap in find_objects(gaps)]
    return sum(length * grid.resolution >= DOUBLING_LENGTH for length in lengths)


def _gaps(grid, across) -> np.ndarray:
    """Free cells with a wall close on both sides along one axis of the grid: bool (rows, cols)."""
    reach = round(DOUBLING_GAP / grid.resolution) + 1
    walls = np.pad(grid.cells == OCCUPIED, reach)
    closed = binary_closing(walls, np.ones((reach, 1) if across == 0 else (1, reach)))
    return closed[reach:-reach, reach:-reach] & (grid.cells == FREE)
