"""Costmaps for cases: ours in this process, and the official costmap_2d_node.

The input of a case has these keys, all but ``costmap`` and ``probes`` optional:

* ``costmap``: parameters of the costmap, ``outer``: parameters of the namespace around it;
* ``maps``: pictures of maps of 0.5 m cells by topic, or (cells, frame), lying at the origin of their frame;
* ``steps``: for each update the sensor messages before it: (topic, points in the base frame), or
  (topic, ranges) of a scan with one beam every 90 degrees from straight ahead;
* ``base``: pose of the robot in the costmap's frame, ``map_in_odom``: pose of the map in odom;
* ``probes``: names and positions in the costmap's frame whose occupancy is returned; ``footprint`` asks for
  the corners of the robot's outline, rounded to millimetres.
"""

import math
from typing import Any, Dict, Mapping, Tuple

import numpy as np

from move_base_lite import settings_from_parameters
from move_base_lite.costmap import (
    LayeredCostmap,
    Observation,
    StaticMap,
    StaticMaps,
    observation_from_points,
    observation_from_scan,
    occupancy_of,
)
from planar import OccupancyGrid, Pose2, Scan, SettingsError, grid_from_picture

RESOLUTION = 0.5
BEAM_ANGLE = math.pi / 2
RANGE_MIN, RANGE_MAX = 0.05, 10.0


def map_of(given: Any) -> Tuple[OccupancyGrid, str]:
    """Return the grid of a case's map and its frame."""
    cells, frame = given if isinstance(given, tuple) else (given, "map")
    if isinstance(cells, str):
        return grid_from_picture(cells, RESOLUTION), frame
    return OccupancyGrid(np.array(cells, dtype=np.int8), RESOLUTION), frame


def run_ours(case: Mapping[str, Any]) -> Dict[str, Any]:
    """Return the occupancy at the probes, or the error that refuses the parameters."""
    try:
        found, _ = settings_from_parameters({**case.get("outer", {}), "local_costmap": case["costmap"]})
    except SettingsError as error:
        return {"error": str(error)}
    settings = found.local_costmap
    maps = StaticMaps()
    for layer in settings.static_layers:
        grid, frame = map_of(case["maps"][layer.map_topic])
        maps = maps.with_map(layer.source, StaticMap(grid, frame))
    costmap = LayeredCostmap(settings, maps)
    base, map_in_odom = Pose2(*case.get("base", (1.25, 1.25, 0.0))), Pose2(*case.get("map_in_odom", ()))
    map_in_frame = map_in_odom if settings.global_frame == "odom" else Pose2()
    for number, messages in enumerate(case.get("steps", [[]])):
        for topic, data in messages:
            costmap.add_observation(_observation(topic, float(number), data), base)
        costmap.update(base, map_in_frame)
    return _observed(costmap, base, case["probes"])


def _observation(topic: str, stamp: float, data: Any) -> Observation:
    data = np.array(data, dtype=float)
    if data.ndim == 1:
        scan = Scan(stamp, 0.0, BEAM_ANGLE, data.astype(np.float32), RANGE_MIN, RANGE_MAX)
        return observation_from_scan(topic, scan)
    return observation_from_points(topic, stamp, Pose2(), data)


def _observed(costmap: LayeredCostmap, base: Pose2, probes: Mapping[str, Any]) -> Dict[str, Any]:
    occupancy, window = occupancy_of(costmap.costs), costmap.window
    found = {}
    for name, place in probes.items():
        if name == "footprint":
            corners_xy = base.transform_points(costmap.footprint.corners_xy) - (base.x, base.y)
            found[name] = [(round(float(x), 3), round(float(y), 3)) for x, y in corners_xy]
        elif name == "size":
            found[name] = window.cols, window.rows
        else:
            found[name] = int(occupancy[window.cell_of(*place)])
    return found
