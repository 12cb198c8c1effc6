"""Warm-up: compile the numba kernels, or load them from the cache, before the first goal."""

from dataclasses import replace

import numpy as np

from move_base_lite.config import NavigatorSettings
from move_base_lite.control.escape import escape_command
from move_base_lite.costmap import NamedLayer, observation_from_points, observation_from_scan
from move_base_lite.costmap.layers.static import StaticSettings
from move_base_lite.navigator import Navigator, NavigatorInputs, RobotState
from planar import OccupancyGrid, Pose2, Scan, Twist2

POINTS = np.array([[1.0, 0.0, 0.5]])


def warm_up(settings: NavigatorSettings) -> None:
    """Run two control periods in an empty map, so that the first goal does not wait for the compiler.

    Args:
        settings: Settings of the Navigator, which select the kernels.
    """
    costmap = settings.global_costmap
    if not costmap.static_layers:
        layers = (NamedLayer("warm_up", StaticSettings()), *costmap.layers)
        settings = replace(settings, global_costmap=replace(costmap, layers=layers))
    navigator = Navigator(settings, OccupancyGrid(np.zeros((60, 60), np.int8), 0.1))
    start = Pose2(3.0, 3.0)
    ranges = np.array([2.0, np.inf, np.nan], dtype=np.float32)
    navigator.set_goal(Pose2(5.0, 3.0))
    for tick in range(2):
        scan = Scan(float(tick), -0.1, 0.1, ranges, 0.1, 10.0)
        observations = [observation_from_scan(settings.scan_topic, scan)]
        for costmap in (settings.global_costmap, settings.local_costmap):
            clouds = (source.topic for source in costmap.sources if source.data_type != "LaserScan")
            observations += [observation_from_points(topic, float(tick), Pose2(), POINTS) for topic in clouds]
        navigator.tick(RobotState(float(tick), start, start, Twist2()), NavigatorInputs(tuple(observations)))
    escape_command(navigator.local_costmap, start)
