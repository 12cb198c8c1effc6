"""Quality of a map compared with the true map."""

from dataclasses import dataclass
from typing import Optional

import numpy as np
from scipy.ndimage import binary_closing, binary_dilation, find_objects, label
from scipy.spatial import cKDTree

from planar.errors import PlanarError
from planar.geometry.distance_field import distance_field
from planar.geometry.grid import FREE, OCCUPIED, OccupancyGrid
from planar.geometry.pose import Pose2
from planar.geometry.ray_casting import cast_rays_from_many

VIEWPOINT_SPACING = 0.25
RAYS = 720
DOUBLING_GAP = 0.30
DOUBLING_LENGTH = 0.30
EIGHT_NEIGHBOURS = np.ones((3, 3), dtype=bool)


@dataclass(frozen=True)
class MapScore:
    """Quality of a map.

    Attributes:
        recall: Share of the visible true wall cells that the map has within the tolerance.
        precision: Share of the map's wall cells that are within the tolerance of a true wall.
        doubled_walls: Number of walls that are drawn twice.
    """

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
    sensor_range: float = 10.0,
    fine_truth: Optional[OccupancyGrid] = None,
) -> MapScore:
    """Compare a map with the true map; extent and resolution may differ.

    Only walls count as visible that a robot could observe from a position it can drive to.

    Args:
        grid: Map.
        truth: True map.
        start_in_truth: Start of the robot, from which positions must be reachable.
        truth_in_map: Pose of the true map's frame in the map.
        tolerance: Distance at which wall cells match [m].
        robot_radius: Radius of the robot [m].
        sensor_range: Range of its laser [m].
        fine_truth: True map with cells small enough for gaps that ``truth`` closes but a laser can see into;
            avoids that they count as doubled walls.

    Raises:
        PlanarError: If the robot cannot stand at ``start_in_truth``.
    """
    mapped_xy = grid.points_of(np.argwhere(grid.cells == OCCUPIED))
    true_xy = truth_in_map.transform_points(truth.points_of(np.argwhere(truth.cells == OCCUPIED)))
    visible_cells = visible_walls(truth, start_in_truth, robot_radius, sensor_range)
    visible_xy = truth_in_map.transform_points(truth.points_of(visible_cells))
    if len(mapped_xy) == 0:
        return MapScore(0.0, 0.0, 0)
    return MapScore(
        recall=_share_near(visible_xy, mapped_xy, tolerance),
        precision=_share_near(mapped_xy, true_xy, tolerance),
        doubled_walls=_count_doubled_walls(grid, fine_truth or truth, truth_in_map, tolerance),
    )


def visible_walls(truth: OccupancyGrid, start: Pose2, robot_radius: float, sensor_range: float) -> np.ndarray:
    """Return the occupied cells that a robot can observe from positions it can drive to.

    Args:
        truth: True map.
        start: Start of the robot in the map.
        robot_radius: Radius of the robot [m].
        sensor_range: Range of its laser [m].

    Returns:
        Cells as (row, col), (N, 2).

    Raises:
        PlanarError: If the robot cannot stand at ``start``.
    """
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
    ranges = cast_rays_from_many(truth, poses, angles, sensor_range)
    depths = ranges + 1e-3 * truth.resolution
    ends_xy = poses[:, None, :2] + depths[:, :, None] * np.column_stack((np.cos(angles), np.sin(angles)))
    cells = np.unique(truth.cells_of(ends_xy[ranges < sensor_range]), axis=0)
    cells = cells[truth.contains(cells)]
    return cells[truth.cells[tuple(cells.T)] == OCCUPIED]


def _share_near(points_xy, others_xy, tolerance) -> float:
    distances, _ = cKDTree(others_xy).query(points_xy)
    return float(np.mean(distances <= tolerance + 1e-9))


def _count_doubled_walls(grid, truth, truth_in_map, tolerance) -> int:
    """Count walls drawn twice: long false gaps between walls, and long false walls beside a correct one."""
    doubled = _long_false_gaps(grid, truth, truth_in_map, tolerance, 0)
    doubled |= _long_false_gaps(grid, truth, truth_in_map, tolerance, 1)
    doubled |= _long(_second_walls(grid, truth, truth_in_map, tolerance), grid.resolution)
    return int(label(binary_dilation(doubled, EIGHT_NEIGHBOURS), EIGHT_NEIGHBOURS)[1])


def _long_false_gaps(grid, truth, truth_in_map, tolerance, across) -> np.ndarray:
    gap_cells = np.argwhere(_gaps(grid, across, DOUBLING_GAP))
    # The map may show a true gap narrower than it is.
    widest = DOUBLING_GAP + 2.0 * tolerance
    true_gaps_xy = [
        truth_in_map.transform_points(truth.points_of(np.argwhere(_gaps(truth, i, widest)))) for i in (0, 1)
    ]
    if len(gap_cells) and any(map(len, true_gaps_xy)):
        distances, _ = cKDTree(np.vstack(true_gaps_xy)).query(grid.points_of(gap_cells))
        gap_cells = gap_cells[distances > tolerance]
    return _long(_mask(grid, gap_cells), grid.resolution, axes=(1 - across,))


def _second_walls(grid, truth, truth_in_map, tolerance) -> np.ndarray:
    """Return false wall cells whose nearest true wall is in the map as well, bool (rows, cols)."""
    cells = np.argwhere(grid.cells == OCCUPIED)
    mapped_xy = grid.points_of(cells)
    true_xy = truth_in_map.transform_points(truth.points_of(np.argwhere(truth.cells == OCCUPIED)))
    distances, nearest = cKDTree(true_xy).query(mapped_xy)
    is_astray = distances > tolerance + 1e-9
    gaps, _ = cKDTree(mapped_xy).query(true_xy[nearest[is_astray]])
    return _mask(grid, cells[is_astray][gaps <= tolerance])


def _gaps(grid, across, widest) -> np.ndarray:
    """Return free cells between walls at most ``widest`` metres apart along one axis, bool (rows, cols)."""
    reach = round(widest / grid.resolution) + 1
    walls = np.pad(grid.cells == OCCUPIED, reach)
    closed = binary_closing(walls, np.ones((reach, 1) if across == 0 else (1, reach)))
    return closed[reach:-reach, reach:-reach] & (grid.cells == FREE)


def _mask(grid, cells) -> np.ndarray:
    mask = np.zeros(grid.cells.shape, dtype=bool)
    mask[tuple(cells.T)] = True
    return mask


def _long(mask, resolution, axes=(0, 1)) -> np.ndarray:
    """Return the parts of a mask that are at least DOUBLING_LENGTH long along one of the axes."""
    pieces, _ = label(mask, EIGHT_NEIGHBOURS)
    is_long = [False]
    for box in find_objects(pieces):
        length = max(box[axis].stop - box[axis].start for axis in axes) * resolution
        is_long.append(length >= DOUBLING_LENGTH)
    return np.array(is_long)[pieces]
