"""Conversion of move_base's parameters, a nested dictionary, to the settings of a Navigator."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Mapping, Tuple, Union

from move_base_lite.config import MoveBaseSettings, NavigatorSettings
from move_base_lite.parameters.costmaps import costmap_settings
from move_base_lite.parameters.planners import (
    REGISTRIES,
    controller_settings,
    other_settings,
    planner_settings,
)
from move_base_lite.parameters.reader import ParameterReader, subtree
from move_base_lite.parameters.recoveries import DEFAULT_RECOVERIES, recovery_settings
from planar.config.without_effect import SettingsWithoutEffect
from planar.config.yaml_table import read_table

# Parameters that are read by other means.
_ELSEWHERE = {
    "recovery_behaviors", "latch_xy_goal_tolerance", "strict_params", "zones_file", "dock", "footprint",
    "robot_radius", "footprint_padding", "obstacle_range", "raytrace_range", "actionlib_status_frequency",
    "status_list_timeout",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class ReadParameters:
    """Result of reading move_base's parameters.

    Attributes:
        settings: The settings.
        warnings: Warnings about unknown, deprecated or invalid parameters.
        unknown: Warnings about unknown parameters among them.
        without_effect: Known parameters that have no effect.
    """

    settings: NavigatorSettings
    warnings: List[str]
    unknown: List[str]
    without_effect: SettingsWithoutEffect


def load_settings(*paths: Union[str, Path], **chosen: Any) -> NavigatorSettings:
    """Read settings from YAML files of official parameters.

    Args:
        paths: YAML files; later ones override earlier ones, as with ``rosparam load``.
        chosen: Parameters of move_base that override those of all files.

    Raises:
        SettingsError: A file cannot be read or a value is invalid.
    """
    parameters: Dict[str, Any] = {}
    for path in paths:
        parameters = merged(parameters, read_table(path).values())
    return settings_from_parameters(merged(parameters, chosen), f"{paths[-1]}: ")[0]


def merged(below: Mapping[str, Any], above: Mapping[str, Any]) -> Dict[str, Any]:
    """Merge two nested dictionaries; values of ``above`` override those of ``below``."""
    both = dict(below)
    for key, value in above.items():
        has_tables = isinstance(value, Mapping) and isinstance(both.get(key), Mapping)
        both[key] = merged(both[key], value) if has_tables else value
    return both


def settings_from_parameters(
    parameters: Mapping[str, Any], where: str = "", is_lenient: bool = False
) -> Tuple[NavigatorSettings, List[str]]:
    """Convert move_base's parameters to settings.

    Args:
        parameters: Nested dictionary as on the parameter server.
        where: Prefix of parameter names in messages.
        is_lenient: Whether a value of a wrong type is ignored with a warning, as in roscpp, instead of
            refused.

    Returns:
        The settings, and warnings about unknown, deprecated or invalid parameters.

    Raises:
        SettingsError: A value is invalid; the text states the full name of the parameter.
    """
    found = read_parameters(parameters, where, is_lenient)
    return found.settings, found.warnings


def read_parameters(
    parameters: Mapping[str, Any], where: str = "", is_lenient: bool = False
) -> ReadParameters:
    """Read move_base's parameters (see settings_from_parameters)."""
    reader = ParameterReader(where, is_lenient)
    move_base = reader.read(MoveBaseSettings, parameters, "", {*_ELSEWHERE, *REGISTRIES})
    costmaps = {
        name: costmap_settings(reader, subtree(parameters, name), name, parameters)
        for name in ("global_costmap", "local_costmap")
    }
    recoveries = recovery_settings(reader, parameters, move_base, costmaps["local_costmap"])
    settings = NavigatorSettings(
        move_base=move_base,
        planner=planner_settings(reader, parameters),
        controller=controller_settings(reader, parameters),
        extensions=other_settings(reader, parameters),
        recoveries=recoveries,
        **costmaps,
    )
    plugins = {name for registry in REGISTRIES.values() for name in registry.namespaces}
    used = {*costmaps, *plugins, *(each.name for each in recoveries), *DEFAULT_RECOVERIES}
    reader.report_unused(parameters, "", used, "no plugin of this name is configured")
    return ReadParameters(settings, reader.warnings, reader.unknown, reader.without_effect)
