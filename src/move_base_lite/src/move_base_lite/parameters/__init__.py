"""move_base's parameters, as a nested dictionary, made into the settings of a Navigator."""

from typing import Any, Dict, List, Mapping, Tuple

from move_base_lite.config import MoveBaseSettings, NavigatorSettings
from move_base_lite.parameters.costmaps import costmap_settings
from move_base_lite.parameters.planners import controller_settings, planner_settings
from move_base_lite.parameters.reader import ParameterReader, subtree
from move_base_lite.parameters.recoveries import recovery_settings
from planar.config.yaml_table import read_table

# Parameters that are known but mean nothing here: of a robot that moves sideways, of details of the official
# code, or read by it and never used.
_MOVE_BASE_IGNORED = {
    "base_global_planner", "base_local_planner", "recovery_behaviors", "latch_xy_goal_tolerance",
    "strict_params", "zones_file", "footprint", "robot_radius", "footprint_padding", "obstacle_range",
     "raytrace_range", "actionlib_status_frequency", "status_list_timeout",
}  # fmt: skip


def load_settings(*paths, **chosen: Any) -> NavigatorSettings:
    """Settings from YAML files of official parameters, later ones over earlier, as ``rosparam load`` does.

    ``chosen``: parameters of move_base over those of all files. Raises SettingsError.
    """
    parameters: Dict[str, Any] = {}
    for path in paths:
        parameters = merged(parameters, read_table(path).values())
    return settings_from_parameters(merged(parameters, chosen), f"{paths[-1]}: ")[0]


def merged(subtree: Mapping[str, Any], above: Mapping[str, Any]) -> Dict[str, Any]:
    """Nested tables, one over the other."""
    both = dict(subtree)
    for key, value in above.items():
        has_tables = isinstance(value, Mapping) and isinstance(both.get(key), Mapping)
        both[key] = merged(both[key], value) if has_tables else value
    return both


def settings_from_parameters(
    parameters: Mapping[str, Any], where: str = "", is_lenient: bool = False
) -> Tuple[NavigatorSettings, List[str]]:
    """Settings from move_base's parameters as a nested dictionary, and warnings for people.

    Raises SettingsError with the full name of the parameter, ``where`` put before it; if ``is_lenient``, a
    value of a wrong type counts as not set, as in roscpp, and is warned of.
    """
    reader = ParameterReader(where, is_lenient)
    move_base = reader.read(MoveBaseSettings, parameters, "", _MOVE_BASE_IGNORED)
    costmaps = {
        name: costmap_settings(reader, subtree(parameters, name), name, parameters)
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
