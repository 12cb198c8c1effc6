"""Suites: scenarios that are evaluated together, as named on the command line."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import List, Sequence, Tuple

from laboratory.launch_files import write_launch_files
from laboratory.scenario import OFFICIAL, Scenario, read_scenario
from move_base_lite.control import check_local_planner
from planar import PlanarError, SettingsError
from planar.files.reading import exists, is_file

ROOT = Path(__file__).resolve().parents[4]
FOLDER = ROOT / "scenarios"


def load_suites(
    suites: Sequence[str], planners: Sequence[str] = (), is_over_ros: bool = False, localizer: str = ""
) -> Tuple[List[Scenario], List[str]]:
    """Load scenarios.

    Args:
        suites: Scenario files, folders of them, or names in ``scenarios/``.
        planners: Local planners to run each scenario with; empty: that of the scenario.
        is_over_ros: Whether they run as a graph of ROS nodes.
        localizer: ``official`` for the official amcl; empty: amcl_lite.

    Returns:
        The scenarios, and an error for each scenario that cannot be run.

    Raises:
        SettingsError: A suite, a planner or the localizer does not exist.
    """
    _check_localizer(localizer, is_over_ros)
    for name in planners:
        _check_planner(name, is_over_ros)
    scenarios, errors = [], []
    for path in [file for suite in suites for file in _files(suite)]:
        try:
            scenario = replace(read_scenario(path), is_over_ros=is_over_ros, localizer=localizer)
            each = [scenario.with_planner(name) for name in planners] or [scenario]
            _check(each[0])
        except PlanarError as error:
            errors.append(str(error))
        else:
            scenarios += each
    return scenarios, errors


def _check_planner(name: str, is_over_ros: bool) -> None:
    if name != OFFICIAL:
        check_local_planner(name)
    else:
        _check_official("move_base", "planner", is_over_ros)


def _check_localizer(name: str, is_over_ros: bool) -> None:
    if name:
        _check_official("amcl", "localizer", is_over_ros)


def _check_official(package: str, option: str, is_over_ros: bool) -> None:
    if not is_over_ros:
        raise SettingsError(f"{option} {OFFICIAL} runs only over ROS; add --over ros")
    from laboratory.ros import official_package

    official_package(package, option)


def load_scenario(name: str, planner: str = "", is_over_ros: bool = False, localizer: str = "") -> Scenario:
    """Load one scenario by file or name. Raises SettingsError if it cannot be run or there are several."""
    scenarios, errors = load_suites([name], [planner] if planner else [], is_over_ros, localizer)
    if errors:
        raise SettingsError(errors[0])
    if len(scenarios) != 1:
        raise SettingsError(f"{name}: expected one scenario, found {len(scenarios)}")
    return scenarios[0]


def _files(suite: str) -> List[Path]:
    for path in (Path(suite), FOLDER / f"{suite}.yaml"):
        if is_file(path):
            return [path]
    if exists(Path(suite)) and Path(suite).is_dir():
        found = sorted(Path(suite).glob("*.yaml"))
        if found:
            return found
        raise SettingsError(f"{suite}: no scenarios (*.yaml) in this folder")
    known = ", ".join(sorted(path.stem for path in FOLDER.glob("*.yaml")))
    raise SettingsError(f"{suite}: not a file, a folder or one of scenarios/ ({known})")


def _check(scenario: Scenario) -> None:
    """Set the scenario up for its first seed. Raises SettingsError that names the file if that fails."""
    from planar.maps.places import obstruction_at
    from sim_bridge import Simulation, robot_named

    start = scenario.start
    try:
        if scenario.planner:
            _check_planner(scenario.planner, scenario.is_over_ros)
        scenario.digest()
        arena = scenario.arena(scenario.seeds[0])
        scenario.task.required_poses(arena)
        obstruction = None if arena.grid is None else obstruction_at(start, arena.grid)
        if obstruction:
            raise SettingsError(f"robot.start ({start.x:g}, {start.y:g}) {obstruction}")
        Simulation(arena.world, robot_named(scenario.robot), scenario.simulation, 0, start).close()
        if scenario.is_over_ros:
            with TemporaryDirectory() as folder:
                write_launch_files(scenario, scenario.seeds[0], Path(folder))
    except PlanarError as error:
        text = str(error)
        raise SettingsError(
            text if text.startswith(str(scenario.file)) else f"{scenario.file}: {text}"
        ) from None
