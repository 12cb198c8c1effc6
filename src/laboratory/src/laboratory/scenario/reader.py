"""Reader of scenario files; every error names file, line and key."""

from pathlib import Path
from typing import Any, Callable, Dict, Mapping, Tuple, TypeVar

from headless_mission import EpisodeConditions
from laboratory.scenario.registry import TASKS, WORLD_SOURCES
from laboratory.scenario.scenario import OFFICIAL, Scenario
from laboratory.scenario.seeds import parse_seeds
from laboratory.tasks.odom_goal import navigation_config
from laboratory.worlds.custom import read_custom_worlds
from laboratory.worlds.doors import read_doors
from laboratory.worlds.people import Pedestrians, read_people
from laboratory.worlds.source import WorldSource
from move_base_lite import settings_from_parameters
from move_base_lite.control import check_local_planner
from planar import Pose2, SettingsError
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
    """Read a scenario file. Raises SettingsError with file, line and key."""
    table = read_table(path)
    table.allow_only(*KEYS)
    robot, start = _read_robot(_part(table, "robot", "profile", "start"))
    happens = _part(table, "happens", "boxes", "doors", "people", "faults")
    planner = _part(table, "planner", "name", "parameters")
    return Scenario(
        name=path.stem,
        file=path.resolve(),
        about=table.text("about") if "about" in table else "",
        world=_read_world(table, path.parent),
        task=_read_kind(table, "task", TASKS, path.parent),
        robot=robot,
        start=start,
        simulation=_read_simulation(table),
        **_read_boxes(happens),
        doors=read_doors(happens) if happens else 0,
        people=read_people(happens) if happens else Pedestrians(),
        faults=faults_from(happens) if happens else (),
        planner=_read_planner(planner) if planner and "name" in planner else "",
        parameters=_read_parameters(planner, robot) if planner else {},
        seconds=_read_seconds(_part(table, "limits", "seconds")),
        seeds=_read_seeds(table),
    )


def _part(table: Table, key: str, *known: str) -> Any:
    """The table of a key, which may only have the known keys; None if it is missing."""
    if key not in table:
        return None
    part = table.table(key)
    part.allow_only(*known)
    return part


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


def _read_boxes(happens: Any) -> Dict[str, Any]:
    """The number of boxes, or a list of their poses."""
    if happens is None or "boxes" not in happens:
        return {}
    if not isinstance(happens.value("boxes"), list):
        return {"boxes": happens.count("boxes")}
    places = happens.tables("boxes")
    for place in places:
        place.allow_only("x", "y", "yaw")
    return {"boxes_at": tuple(map(parse_pose, places))}


def _read_robot(table: Any) -> Tuple[str, Pose2]:
    if table is None:
        return Scenario.robot, Scenario.start
    name = table.text("profile", Scenario.robot)
    try:
        robot_named(name)
    except RobotError as error:
        raise table.error_at("profile", f"cannot be used: {error}") from None
    start = Scenario.start
    if "start" in table:
        start_table = table.table("start")
        start_table.allow_only("x", "y", "yaw")
        start = parse_pose(start_table)
    return name, start


def _read_simulation(table: Table) -> SimulationSettings:
    """A noise profile, and single values that override it."""
    if "simulation" not in table:
        return SimulationSettings()
    part = table.table("simulation")
    values: Dict[str, Any] = {key: part.value(key) for key in part if key != "noise"}
    try:
        noise = noise_named(part.text("noise", "turtlebot"))
    except SettingsError as error:
        raise part.error_at("noise", f"cannot be used: {error}") from None
    settings, unknown = settings_from(SimulationSettings, {**noise, **values}, where=part.location_of)
    if unknown:
        part.allow_only("noise", *(key for key in part if key not in unknown))
    return settings


def _read_planner(planner: Table) -> str:
    name = planner.text("name")
    try:
        if name != OFFICIAL:
            check_local_planner(name)
    except SettingsError as error:
        raise planner.error_at("name", f"cannot be used: {error}") from None
    return name


def _read_parameters(planner: Table, robot: str) -> Mapping[str, Any]:
    """Parameters of move_base by their official names; unknown ones are an error."""
    if "parameters" not in planner:
        return {}
    values = planner.table("parameters").values()
    name = planner.text("name") if "name" in planner else ""
    try:
        EpisodeConditions(name, values).navigation(navigation_config(robot))
        _, warnings = settings_from_parameters({**values, **({"base_local_planner": name} if name else {})})
    except SettingsError as error:
        raise planner.error_at("parameters", f"cannot be used: {error}") from None
    if warnings:
        raise planner.error_at("parameters", f"cannot be used: {warnings[0]}")
    return values


def _read_seconds(limits: Any) -> float:
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
