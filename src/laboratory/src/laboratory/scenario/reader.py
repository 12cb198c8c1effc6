"""Reader of scenario files; all mistakes are reported at once, with file, line and key."""

from dataclasses import fields
from pathlib import Path
from typing import Any, Callable, Dict, Mapping, Optional, Tuple, TypeVar

from headless_mission import EpisodeConditions
from laboratory.scenario.registry import TASKS, WORLD_SOURCES
from laboratory.scenario.scenario import OFFICIAL, Scenario
from laboratory.scenario.seeds import parse_seeds
from laboratory.tasks.odom_goal import navigation_config
from laboratory.worlds.custom import read_custom_worlds
from laboratory.worlds.doors import read_doors
from laboratory.worlds.people import read_people
from laboratory.worlds.source import WorldSource
from move_base_lite import settings_from_parameters
from move_base_lite.control import check_local_planner
from planar import Pose2, SettingsError
from planar.config.error_list import ErrorList, read_each
from planar.config.hints import hint
from planar.config.settings import settings_from
from planar.config.yaml_table import Table, read_table
from planar.maps.places import parse_pose
from sim_bridge import RobotError, SimulationSettings, robot_named
from sim_bridge.faults.file import faults_from
from sim_bridge.noise import noise_named

KEYS = ("about", "world", "robot", "simulation", "task", "happens", "planner", "limits", "seeds")
Kind = TypeVar("Kind")


def read_scenario(path: Path) -> Scenario:
    """Read a scenario file. Raises SettingsError with file, line and key of every mistake."""
    table, errors = read_table(path), ErrorList()
    errors.read(table.allow_only, *KEYS)
    about = errors.read(table.text, "about") if "about" in table else ""
    world = errors.read(_read_world, table, path.parent)
    robot, start = errors.read(_read_robot, table) or (Scenario.robot, Scenario.start)
    parts: Dict[str, Any] = {
        "about": about,
        "world": world,
        "simulation": errors.read(_read_simulation, table),
        "task": errors.read(_read_kind, table, "task", TASKS, path.parent),
        **(errors.read(_read_happens, table) or {}),
        **(errors.read(_read_planner, table, robot) or {}),
        "seconds": errors.read(_read_seconds, table),
        "seeds": errors.read(_read_seeds, table),
    }
    errors.raise_all()
    return Scenario(name=path.stem, file=path.resolve(), robot=robot, start=start, **parts)


def _part(table: Table, key: str, errors: ErrorList, *known: str) -> Optional[Table]:
    """The table of a key, which may only have the known keys; None if it is missing or no table."""
    part = errors.read(table.table, key) if key in table else None
    if part is not None:
        errors.read(part.allow_only, *known)
    return part


def _read_happens(table: Table) -> Dict[str, Any]:
    errors = ErrorList()
    happens = _part(table, "happens", errors, "boxes", "moves", "doors", "people", "faults")
    parts: Dict[str, Any] = {}
    if happens is not None:
        parts.update(errors.read(_read_boxes, happens) or {})
        parts.update(errors.read(_read_moves, happens) or {})
        for key, reader in (("doors", read_doors), ("people", read_people), ("faults", faults_from)):
            parts[key] = errors.read(reader, happens)
    errors.raise_all()
    return parts


def _read_world(table: Table, folder: Path) -> WorldSource:
    """An included world source, or a custom generator if a key is a dotted name."""
    part = table.table("world")
    custom = next((key for key in part if "/" in key), None)
    return (
        _read_kind(table, "world", WORLD_SOURCES, folder)
        if custom is None
        else read_custom_worlds(part, custom)
    )


def _read_kind(
    table: Table, key: str, kinds: Mapping[str, Callable[[Table, Path], Kind]], folder: Path
) -> Kind:
    """Read the table of a key with the reader whose name is one of its keys."""
    part = table.table(key)
    found = [known for known in part if known in kinds]
    if not found:
        given = next(iter(part), "")
        raise table.error_at(key, f"needs one of {', '.join(kinds)}{hint(given, kinds)}")
    return kinds[found[0]](part, folder)


def _read_boxes(happens: Table) -> Dict[str, Any]:
    """The number of boxes, or a list of their poses."""
    if "boxes" not in happens:
        return {}
    if not isinstance(happens.value("boxes"), list):
        return {"boxes": happens.count("boxes")}
    return {"boxes_at": read_each(_read_pose, happens.tables("boxes"))}


def _read_moves(happens: Table) -> Dict[str, Any]:
    if "moves" not in happens:
        return {}
    if "boxes" not in happens:
        raise happens.error_at("moves", "needs boxes that are moved: add boxes")
    return {"moves": happens.count("moves")}


def _read_pose(table: Table) -> Pose2:
    table.allow_only("x", "y", "yaw")
    return parse_pose(table)


def _read_robot(table: Table) -> Tuple[str, Pose2]:
    errors = ErrorList()
    part = _part(table, "robot", errors, "profile", "start")
    name, start = Scenario.robot, Scenario.start
    if part is not None:
        name = errors.read(_read_profile, part) or name
        if "start" in part:
            start = errors.read(lambda: _read_pose(part.table("start"))) or start
    errors.raise_all()
    return name, start


def _read_profile(robot: Table) -> str:
    name = robot.text("profile", Scenario.robot)
    try:
        robot_named(name)
    except RobotError as error:
        raise robot.error_at("profile", f"cannot be used: {error}") from None
    return name


def _read_simulation(table: Table) -> SimulationSettings:
    """A noise profile, and single values that override it."""
    if "simulation" not in table:
        return SimulationSettings()
    part, errors = table.table("simulation"), ErrorList()
    values: Dict[str, Any] = {key: part.value(key) for key in part if key != "noise"}
    noise = errors.read(_read_noise, part) or {}
    known = {field.name for field in fields(SimulationSettings)}
    errors.read(part.allow_only, "noise", *known)
    given = {**noise, **{key: value for key, value in values.items() if key in known}}
    read = errors.read(lambda: settings_from(SimulationSettings, given, where=part.location_of)[0])
    errors.raise_all()
    return read or SimulationSettings()


def _read_noise(simulation: Table) -> Dict[str, Any]:
    try:
        return noise_named(simulation.text("noise", "turtlebot"))
    except SettingsError as error:
        raise simulation.error_at("noise", f"cannot be used: {error}") from None


def _read_planner(table: Table, robot: str) -> Dict[str, Any]:
    """Name of the local planner and parameters of move_base."""
    errors = ErrorList()
    planner = _part(table, "planner", errors, "name", "parameters")
    parts: Dict[str, Any] = {}
    if planner is not None:
        parts["planner"] = (errors.read(_read_planner_name, planner) if "name" in planner else "") or ""
        parts["parameters"] = errors.read(_read_parameters, planner, parts["planner"], robot)
    errors.raise_all()
    return parts


def _read_planner_name(planner: Table) -> str:
    name = planner.text("name")
    try:
        if name != OFFICIAL:
            check_local_planner(name)
    except SettingsError as error:
        raise planner.error_at("name", f"cannot be used: {error}") from None
    return name


def _read_parameters(planner: Table, name: str, robot: str) -> Mapping[str, Any]:
    """Parameters of move_base by their official names; unknown ones are an error."""
    if "parameters" not in planner:
        return {}
    values = planner.table("parameters").values()
    try:
        EpisodeConditions(name, values).navigation(navigation_config(robot))
        _, warnings = settings_from_parameters({**values, **({"base_local_planner": name} if name else {})})
    except SettingsError as error:
        raise planner.error_at("parameters", f"cannot be used: {error}") from None
    if warnings:
        raise planner.error_at("parameters", f"cannot be used: {'; '.join(warnings)}")
    return values


def _read_seconds(table: Table) -> float:
    errors = ErrorList()
    limits = _part(table, "limits", errors, "seconds")
    errors.raise_all()
    if limits is None:
        return Scenario.seconds
    seconds = limits.number("seconds")
    limits.check(seconds > 0.0, "seconds", "positive")
    return seconds


def _read_seeds(table: Table) -> Tuple[int, ...]:
    if "seeds" not in table:
        return Scenario.seeds
    try:
        return parse_seeds(table.text("seeds"))
    except SettingsError as error:
        raise table.error_at("seeds", f"cannot be used: {error}") from None
