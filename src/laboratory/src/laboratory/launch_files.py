"""Files and launch arguments that describe a scenario to the ROS nodes."""

import dataclasses
import math
from pathlib import Path
from typing import Any, Dict, Optional

import yaml

from cockpit.scene.description import DESCRIPTION_SUFFIX
from laboratory.scenario.scenario import OFFICIAL, Scenario
from planar import Pose2, SettingsError, save_map, write_atomically
from sim_bridge.faults import Fault
from sim_bridge.world import World


def write_launch_files(
    scenario: Scenario, seed: int, folder: Path, start: Optional[Pose2] = None
) -> Dict[str, Any]:
    """Write the files of a scenario.

    Args:
        scenario: The scenario.
        seed: Seed of the run.
        folder: Folder for the files.
        start: Start pose, if it is not that of the scenario.

    Returns:
        The arguments of the launch file.

    Raises:
        PlanarError: The scenario cannot be run over ROS.
    """
    arena = scenario.arena(seed)
    files = scenario.task.launch_files(arena, seed, folder)
    if arena.grid is None:
        raise SettingsError(f"{scenario.file}: a run over ROS needs a world with a map")
    parameters = node_parameters(scenario, start)
    shown = {"/cockpit/world": str(_write_description(arena.world, folder))}
    arguments: Dict[str, Any] = {
        "world_file": scenario.file.resolve(),
        "seed": seed,
        "robot": scenario.robot,
        "map_file": save_map(arena.grid, folder / "map"),
        "parameters_file": write_yaml(folder / "parameters.yaml", {**parameters, **shown}),
        **files,
    }
    arguments.update(_planner_arguments(scenario.planner))
    if scenario.localizer:
        from laboratory.ros import official_package

        arguments["amcl_pkg"] = official_package("amcl", "localizer")
    if scenario.faults:
        faults = {"faults": [fault_table(fault) for fault in scenario.faults]}
        arguments["faults_file"] = write_yaml(folder / "faults.yaml", faults)
    return arguments


def _write_description(world: World, folder: Path) -> Path:
    """Write what the cockpit shows of a generated world; return the path."""
    from cockpit.scene.reader import describe_bodies

    path = folder / f"world{DESCRIPTION_SUFFIX}"
    write_atomically(path, describe_bodies(world).to_bytes())
    return path


def _planner_arguments(planner: str) -> Dict[str, str]:
    if planner != OFFICIAL:
        return {"planner": planner} if planner else {}
    from laboratory.ros import official_package

    return {"move_base_pkg": official_package("move_base", "planner")}


def node_parameters(scenario: Scenario, start: Optional[Pose2] = None) -> Dict[str, Any]:
    """Return the parameters of each node that differ from their defaults.

    Args:
        scenario: The scenario.
        start: Start pose, if it is not that of the scenario.
    """
    start = start or scenario.start
    initial = {f"initial_pose_{key}": value for key, value in zip("xya", (start.x, start.y, start.yaw))}
    simulation = dataclasses.asdict(scenario.simulation)
    return {
        "/sim_bridge": {**simulation, "x": start.x, "y": start.y, "yaw": start.yaw},
        "/amcl": initial,
        "/move_base": dict(scenario.parameters),
    }


def fault_table(fault: Fault) -> Dict[str, Any]:
    """Return a fault as an entry of a faults file."""
    table = dataclasses.asdict(fault)
    return {key: value for key, value in table.items() if value != math.inf}


def write_yaml(path: Path, content: Any) -> Path:
    """Write ``content`` as YAML; return the path."""
    write_atomically(path, yaml.safe_dump(content, sort_keys=False).encode("utf-8"))
    return path
