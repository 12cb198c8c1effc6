"""One scenario played by the graph of nodes, in processes of their own."""

import json
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, List, Mapping

import numpy as np

from home_service.judging.verdict import collision
from laboratory.tasks.task import COLLISION, FAILURE, SUCCESS, TIMEOUT, Play
from laboratory.worlds.source import Arena
from planar import SettingsError
from planar.files.reading import read_text
from supervision.guard import guarded

if TYPE_CHECKING:
    from laboratory.scenario.scenario import Scenario

# Wall seconds that a run may take for each simulated one, to come up, and to end.
PACE, BRINGING_UP_SECONDS, ENDING_SECONDS = 4.0, 120.0, 60.0


def play_over_ros(scenario: "Scenario", arena: Arena, seed: int) -> Play:
    """As the task's own ``play``. Raises SettingsError if the graph leaves no result."""
    patience = scenario.seconds * PACE + BRINGING_UP_SECONDS
    with tempfile.TemporaryDirectory(prefix="over-ros-") as parent:
        command = [sys.executable, "-m", "laboratory", "play", str(scenario.file), "--over", "ros"]
        command += ["--seed", str(seed), "--output", parent, "--timeout", f"{patience:g}"]
        if scenario.planner:
            command += ["--planner", scenario.planner]
        said = _said_by(guarded(command, ENDING_SECONDS), patience + ENDING_SECONDS)
        results = list(Path(parent).glob("*/result.json"))
        if not results:
            raise SettingsError(f"{scenario.file}: over ROS: {said[-1] if said else 'no result'}")
        played = _play_of(results[0].parent, scenario.seconds)
        return replace(played, way=scenario.task.way(scenario, arena))


def _said_by(command: List[str], patience: float) -> List[str]:
    """Lines that it has printed, however it ended."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        return process.communicate(timeout=patience)[0].splitlines()
    except subprocess.TimeoutExpired:
        process.terminate()
        return process.communicate()[0].splitlines()


def _play_of(folder: Path, seconds: float) -> Play:
    """What a run folder tells."""
    result = json.loads(read_text(folder / "result.json"))
    truth, estimate = (_poses_of(folder / f"trajectory_{name}.tum") for name in ("true", "estimated"))
    if len(truth) < 2:
        raise SettingsError(f"over ROS: {result['reason']}")
    # What nodes take to end, which depends on the machine, is none of the run.
    end = truth[0, 0] + result.get("simulated_seconds", np.inf)
    truth, estimate = (poses[poses[:, 0] <= end] for poses in (truth, estimate))
    touched = result.get("collisions", ())
    return Play(
        _outcome(result, touched, seconds), result["reason"], truth, _errors(truth, estimate), touched
    )


def _outcome(result: Mapping[str, Any], touched: Any, seconds: float) -> str:
    if result["success"]:
        return SUCCESS
    if collision(touched):
        return COLLISION
    return TIMEOUT if result.get("simulated_seconds", 0.0) > seconds else FAILURE


def _errors(truth: np.ndarray, estimate: np.ndarray) -> np.ndarray:
    """Distances (M,) between estimated places and the true ones at their stamps."""
    there = [np.interp(estimate[:, 0], truth[:, 0], truth[:, axis]) for axis in (1, 2)]
    errors: np.ndarray = np.hypot(estimate[:, 1] - there[0], estimate[:, 2] - there[1])
    return errors


def _poses_of(path: Path) -> np.ndarray:
    """Stamps and poses (N, 4) of a trajectory in the TUM format."""
    rows = np.loadtxt(path, ndmin=2) if path.exists() else np.empty((0, 8))
    rows = rows.reshape(-1, 8)
    yaw = 2.0 * np.arctan2(rows[:, 6], rows[:, 7])
    return np.column_stack((rows[:, :3], yaw))
