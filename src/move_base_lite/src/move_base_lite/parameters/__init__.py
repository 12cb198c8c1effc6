"""move_base's parameters, as a nested dictionary, made into the settings of a Navigator."""

from typing import Any, List, Mapping, Tuple

import yaml

from move_base_lite.config import MoveBaseSettings, NavigatorSettings
from move_base_lite.parameters.costmaps import costmap_settings
from move_base_lite.parameters.planners import controller_settings, planner_settings
from move_base_lite.parameters.reader import Reader, below
from move_base_lite.parameters.recoveries import recovery_settings

# Parameters that are known but mean nothing here: of a robot that moves sideways, of details of the official
# code, or read by it and never used.
_MOVE_BASE_IGNORED = {
    "base_global_planner", "base_local_planner", "recovery_behaviors", "latch_xy_goal_tolerance",
    "restore_defaults", "strict_params", "zones_file", "footprint", "robot_radius", "footprint_padding",
    "obstacle_range", "raytrace_range", "actionlib_status_frequency", "status_list_timeout",
}  # fmt: skip


def load_settings(path) -> NavigatorSettings:
    """Settings from a YAML file of official parameters, as ``rosparam load`` would read it."""
    with open(path, encoding="utf-8") as file:  # noqa: PTH123
        parameters = yaml.safe_load(file)
    return settings_from_parameters(parameters, str(path) + ": ")[0]


def settings_from_parameters(
    parameters: Mapping[str, Any], where: str = ""
) -> Tuple[NavigatorSettings, List[str]]:
    """Settings from move_base's parameters as a nested dictionary, and warnings for people.

    Raises SettingsError with the full name of the parameter, ``where`` put before it.
    """
    reader = Reader(where)
    move_base = reader.read(MoveBaseSettings, parameters, "", _MOVE_BASE_IGNORED)
    costmaps = {
        name: costmap_settings(reader, below(parameters, name), name, parameters)
        for name in ("global_costmap", "local_costmap")
    }
    settings = NavigatorSettings(
        move_base=move_base,
        planner=planner_settings(reader, parameters),
        controller=controller_settings(reader, parameters),
        recoveries=recovery_settings(reader, parameters, move_base, costmaps["local_costmap"]),
        **costmaps,
    )
    return settings, reader.warnings
