"""move_base for cases: its dynamic parameters, its recovery behaviors and its plans; ours in this process.

Inputs of the rigs:

* ``parameters``: ``server``, the namespace of a dynamic_reconfigure server below move_base, the ``name`` of a
  parameter, and ``parameters`` of move_base; the result is (value, low, high), without limits for texts and
  booleans;
* ``recoveries``: ``parameters``; the result is the list of names of the behaviors;
* ``plans``: ``map``, a picture with cells of 0.25 m, ``start``, ``goal``, ``tolerance`` and ``parameters``.
"""

import math
from typing import Any, Dict, List, Mapping, Tuple

import numpy as np

from move_base_lite import Navigator, settings_from_parameters
from move_base_lite.errors import PlanningError
from move_base_lite.parameters.reconfigure import reconfigure_servers
from planar import Pose2, SettingsError, grid_from_picture

PLAN_RESOLUTION = 0.25
FRAMES = {"global_frame": "map", "robot_base_frame": "base_link"}


def parameters_of_ours(given: Mapping[str, Any]) -> Tuple[Any, ...]:
    """Value and limits of a dynamic parameter of ours."""
    servers = reconfigure_servers(with_frames(given.get("parameters", {})))
    for tunable, value in servers[given["server"]]:
        if tunable.name == given["name"]:
            if isinstance(value, (bool, str)):
                return (value,)
            low, high = (None if math.isinf(limit) else float(limit) for limit in (tunable.low, tunable.high))
            return float(value), low, high
    return ("not offered",)


def recoveries_of_ours(given: Mapping[str, Any]) -> List[str]:
    """Names of the recovery behaviors of ours, in order."""
    try:
        settings, _ = settings_from_parameters(given["parameters"])
    except SettingsError as error:
        return [f"error: {error}"]
    return [each.name for each in settings.recoveries]


def plan_of_ours(given: Mapping[str, Any]) -> Dict[str, Any]:
    """A plan of ours: whether there is one, where it ends, whether it crosses walls or makes a detour."""
    settings, _ = settings_from_parameters(plan_parameters(given))
    navigator = Navigator(settings, grid_from_picture(given["map"], PLAN_RESOLUTION))
    try:
        start, goal = Pose2(*given["start"]), Pose2(*given["goal"])
        path_xy = navigator.make_plan(start, goal, given.get("tolerance", 0.0))
    except PlanningError:
        return {"found": False}
    return described(path_xy, given)


def with_frames(parameters: Mapping[str, Any]) -> Dict[str, Any]:
    """Parameters with costmaps that need no map, unless they state their layers."""
    own = dict(parameters)
    for name in ("global_costmap", "local_costmap"):
        own[name] = {**FRAMES, **own.get(name, {})}
    return own


def plan_parameters(given: Mapping[str, Any]) -> Dict[str, Any]:
    """Parameters of move_base with a static layer and a small robot."""
    plugins = [{"name": "static", "type": "costmap_2d::StaticLayer"}]
    plugins.append({"name": "inflation", "type": "costmap_2d::InflationLayer"})
    inflation = {"inflation_radius": 0.3}
    global_costmap = {"plugins": plugins, "inflation": inflation, "robot_radius": 0.3}
    local_costmap = {"rolling_window": True, "width": 2, "height": 2, "robot_radius": 0.05}
    return with_frames(
        {
            **given.get("parameters", {}),
            "global_costmap": {**global_costmap, **given.get("global_costmap", {})},
            "local_costmap": local_costmap,
        }
    )


def described(path_xy: np.ndarray, given: Mapping[str, Any]) -> Dict[str, Any]:
    """Properties of a path that do not depend on its discretisation."""
    end = tuple(round(float(each), 2) for each in path_xy[-1])
    grid = grid_from_picture(given["map"], PLAN_RESOLUTION)
    crosses = any(grid.value_at(float(x), float(y)) > 0 for x, y in path_xy[1:-1])
    direct = math.dist(path_xy[0], path_xy[-1])
    length = float(np.linalg.norm(np.diff(path_xy, axis=0), axis=1).sum())
    return {"found": True, "end": end, "crosses": crosses, "is_detour": length > 1.5 * direct}
