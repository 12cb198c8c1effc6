"""What the nodes are told of a scenario, as files: what in one process are values."""

import dataclasses
import math
from pathlib import Path
from typing import Any, Dict

import yaml

from laboratory.scenario.scenario import OFFICIAL, Scenario
from planar import SettingsError, save_map, write_atomically
from sim_bridge.faults import Fault


def write_launch_files(scenario: Scenario, seed: int, folder: Path) -> Dict[str, Any]:
    """Writes them into ``folder``; returns the arguments of scenario.launch.

    Raises PlanarError if the nodes cannot play it.
    """
    arena = scenario.arena(seed)
    files = scenario.task.launch_files(arena, seed, folder)
    if arena.grid is None:
        raise SettingsError(f"{scenario.file}: nodes can only play in a world with a map")
    arguments: Dict[str, Any] = {
        "world_file": scenario.file.resolve(),
        "seed": seed,
        "robot": scenario.robot,
        "map_file": save_map(arena.grid, folder / "map"),
        "marker_mode": "mission" if "mission_file" in files else "service",
        "parameters_file": write_yaml(folder / "parameters.yaml", node_parameters(scenario)),
        **files,
    }
    arguments.update(_driver(scenario.planner))
    if scenario.faults:
        faults = {"faults": [fault_table(fault) for fault in scenario.faults]}
        arguments["faults_file"] = write_yaml(folder / "faults.yaml", faults)
    return arguments


def _driver(planner: str) -> Dict[str, str]:
    if planner != OFFICIAL:
        return {"planner": planner} if planner else {}
    from laboratory.ros import official_move_base

    return {"move_base_pkg": official_move_base()}


def node_parameters(scenario: Scenario) -> Dict[str, Any]:
    """By node, its parameters that are not as usual."""
    start = scenario.start
    initial = {f"initial_pose_{key}": value for key, value in zip("xya", (start.x, start.y, start.yaw))}
    simulation = dataclasses.asdict(scenario.simulation)
    return {
        "/sim_bridge": {**simulation, "x": start.x, "y": start.y, "yaw": start.yaw},
        "/amcl": initial,
        "/move_base": dict(scenario.parameters),
    }


def fault_table(fault: Fault) -> Dict[str, Any]:
    """As a list of faults has it."""
    table = dataclasses.asdict(fault)
    return {key: value for key, value in table.items() if value != math.inf}


def write_yaml(path: Path, content: Any) -> Path:
    """Returns the path."""
    write_atomically(path, yaml.safe_dump(content, sort_keys=False).encode("utf-8"))
    return path
