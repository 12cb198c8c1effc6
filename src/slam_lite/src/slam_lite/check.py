"""Contract check of custom scan matchers: ``python3 -m slam_lite.check NAME``.

Each check gets settings that choose a matcher. The first line of its docstring is printed.
"""

import sys

import numpy as np

from planar import OccupancyGrid, Pose2, Scan, grid_from_picture, wrap
from planar.geometry.ray_casting import cast_rays
from planar.plugin_check import CheckSuite, expect, plugin_finder, run_checks
from slam_lite.config import MapperSettings
from slam_lite.matching.local_map import LocalMap, Match
from slam_lite.matching.scan_matcher import CONTRACT, Prediction, scan_matcher_of
from slam_lite.point_cloud import PointCloud, point_cloud_of

ROOM = "##########\n#........#\n#........#\n#....#...#\n#....#####\n##########"
CORRIDOR = "#" * 60 + "\n" + "." * 60 + "\n" + "." * 60 + "\n" + "." * 60 + "\n" + "#" * 60
ANGLES, RANGE_MAX = np.linspace(-np.pi, np.pi, 240, endpoint=False), 6.0
HERE, STEP = Pose2(1.2, 1.6, 0.4), Pose2(0.2, 0.0, 0.1)
# Error of odometry over a step, and its variance, m^2, m^2, rad^2.
ERROR, VARIANCE = Pose2(0.06, -0.04, 0.04), np.array([0.01, 0.01, 0.01])


def finds_the_pose(settings: MapperSettings) -> None:
    """It finds the pose of a scan to 3 cm and 0.02 rad, from a prediction 7 cm off."""
    for step in (STEP, Pose2(0.0, 0.0, 0.2), Pose2(-0.2, 0.1, -0.1)):
        truth = HERE @ step
        match = _matched(settings, _seen(ROOM, truth), _map(ROOM, HERE), truth @ ERROR)
        off, turned = match.base_pose.distance_to(truth), abs(wrap(match.base_pose.yaw - truth.yaw))
        expect(off <= 0.03 and turned <= 0.02, f"{off:.3f} m and {turned:.3f} rad off")
        expect(match.response >= 0.5, f"a response of {match.response:.2f} to a scan that matches")


def responds_less_to_scans_that_do_not_match(settings: MapperSettings) -> None:
    """The response to a scan of another place is lower than to one that matches."""
    local_map, elsewhere = _map(ROOM, HERE), _seen(CORRIDOR, Pose2(15.0, 1.0, 0.4))
    matching = _matched(settings, _seen(ROOM, HERE), local_map, HERE).response
    other = _matched(settings, elsewhere, local_map, HERE).response
    expect(other < matching, f"a response of {other:.2f}, and of {matching:.2f} to a scan that matches")


def follows_odometry_along_a_corridor(settings: MapperSettings) -> None:
    """Along a smooth corridor, which scans do not measure, it follows odometry."""
    there, predicted = Pose2(15.3, 1.25), Pose2(15.25, 1.27)
    match = _matched(settings, _seen(CORRIDOR, there), _map(CORRIDOR, Pose2(15.0, 1.25)), predicted)
    off = abs(match.base_pose.x - predicted.x)
    expect(off <= 0.05, f"{off:.2f} m from odometry")


def accepts_scans_without_points(settings: MapperSettings) -> None:
    """A scan without points leaves the prediction unchanged."""
    no_points = np.empty((0, 2), np.float32)
    match = _matched(settings, PointCloud(no_points, no_points), _map(ROOM, HERE), HERE)
    off = match.base_pose.distance_to(HERE)
    expect(off <= 1e-6, f"{off:.2g} m away")


def is_deterministic(settings: MapperSettings) -> None:
    """The same calls give the same results."""
    cloud, local_map = _seen(ROOM, HERE @ STEP), _map(ROOM, HERE)
    first, second = (_matched(settings, cloud, local_map, HERE) for _ in range(2))
    expect(first.base_pose == second.base_pose, f"{first.base_pose}, then {second.base_pose}")


def _seen(picture: str, base: Pose2) -> PointCloud:
    coarse = grid_from_picture(picture, 0.5)
    grid = OccupancyGrid(np.kron(coarse.cells, np.ones((10, 10), np.int8)), 0.05)
    ranges = cast_rays(grid, base, ANGLES, 2.0 * RANGE_MAX).astype(np.float32)
    scan = Scan(0.0, ANGLES[0], ANGLES[1] - ANGLES[0], ranges, 0.05, RANGE_MAX)
    return point_cloud_of(scan, RANGE_MAX, MapperSettings().point_spacing)


def _map(picture: str, base: Pose2) -> LocalMap:
    """A local map of what is visible in a picture from one pose."""
    local_map = LocalMap(reach=10.0)
    local_map.clear(base)
    local_map.add(_seen(picture, base), base)
    return local_map


def _matched(settings: MapperSettings, cloud: PointCloud, local_map: LocalMap, predicted: Pose2) -> Match:
    return scan_matcher_of(settings).match(cloud, local_map, Prediction(predicted, VARIANCE, VARIANCE))


CHECKS = (
    finds_the_pose,
    responds_less_to_scans_that_do_not_match,
    follows_odometry_along_a_corridor,
    accepts_scans_without_points,
    is_deterministic,
)
CHECK_SUITES = {
    "scan_matcher": CheckSuite(
        plugin_finder(CONTRACT, lambda name: MapperSettings(matcher_plugin=name)), CHECKS
    )
}


if __name__ == "__main__":
    sys.exit(run_checks("slam_lite", CHECK_SUITES))
