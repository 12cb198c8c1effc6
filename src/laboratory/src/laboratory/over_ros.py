"""Run a scenario as a graph of ROS nodes in child processes."""

import json
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, List

import numpy as np

from laboratory.tasks.task import RunTrace, outcome_of
from laboratory.worlds.source import Arena
from planar import SettingsError
from planar.files.reading import read_text
from supervision.guard import guarded

if TYPE_CHECKING:
    from laboratory.scenario.scenario import Scenario

# Maximum wall-clock time for each simulated second, for the start and for the shutdown of the nodes [s].
WALL_SECONDS_PER_SIMULATED, STARTUP_SECONDS, SHUTDOWN_SECONDS = 4.0, 120.0, 60.0


def run_over_ros(scenario: "Scenario", arena: Arena, seed: int) -> RunTrace:
    """Do what ``Task.run`` does, over ROS. Raises SettingsError if the nodes leave no result."""
    timeout = scenario.seconds * WALL_SECONDS_PER_SIMULATED + STARTUP_SECONDS
    with tempfile.TemporaryDirectory(prefix="over-ros-") as parent:
        command = [sys.executable, "-m", "laboratory", "play", str(scenario.file), "--over", "ros"]
        command += ["--seed", str(seed), "--output", parent, "--timeout", f"{timeout:g}"]
        if scenario.planner:
            command += ["--planner", scenario.planner]
        if scenario.localizer:
            command += ["--localizer", scenario.localizer]
        output = _run_command(guarded(command, SHUTDOWN_SECONDS), timeout + SHUTDOWN_SECONDS)
        results = list(Path(parent).glob("*/result.json"))
        if not results:
            raise SettingsError(f"{scenario.file}: over ROS: {output[-1] if output else 'no result'}")
        trace = _read_trace(results[0].parent, scenario.seconds)
        return replace(trace, reference_length=scenario.task.reference_length(scenario, arena))


def _run_command(command: List[str], timeout: float) -> List[str]:
    """Run a command; return the lines it printed, whatever its exit code."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        return process.communicate(timeout=timeout)[0].splitlines()
    except subprocess.TimeoutExpired:
        process.terminate()
        return process.communicate()[0].splitlines()


def _read_trace(folder: Path, seconds: float) -> RunTrace:
    """Read the trace of a run from its run folder."""
    result = json.loads(read_text(folder / "result.json"))
    truth, estimate = (_read_trajectory(folder / f"trajectory_{name}.tum") for name in ("true", "estimated"))
    if len(truth) < 2:
        raise SettingsError(f"over ROS: {result['reason']}")
    # Poses after the end of the mission depend on how fast the machine shuts the nodes down.
    end = truth[0, 0] + result.get("simulated_seconds", np.inf)
    truth, estimate = (poses[poses[:, 0] <= end] for poses in (truth, estimate))
    collisions = result.get("collisions", ())
    duration = result.get("simulated_seconds", 0.0)
    outcome = result.get("outcome") or outcome_of(result["success"], collisions, duration, seconds)
    errors, score = _errors(truth, estimate), result.get("score")
    return RunTrace(outcome, result["reason"], truth, errors, collisions, score=score)


def _errors(truth: np.ndarray, estimate: np.ndarray) -> np.ndarray:
    """Distances (M,) between estimated and true positions at the stamps of the estimates."""
    true_xy = [np.interp(estimate[:, 0], truth[:, 0], truth[:, axis]) for axis in (1, 2)]
    errors: np.ndarray = np.hypot(estimate[:, 1] - true_xy[0], estimate[:, 2] - true_xy[1])
    return errors


def _read_trajectory(path: Path) -> np.ndarray:
    """Stamps and poses (N, 4) of a trajectory in the TUM format."""
    rows = np.loadtxt(path, ndmin=2) if path.exists() else np.empty((0, 8))
    rows = rows.reshape(-1, 8)
    yaw = 2.0 * np.arctan2(*rows[:, 6:].T.copy())
    return np.column_stack((rows[:, :3], yaw))
