"""Mapping runs: driven by hand, or by the explorer."""

import os
import subprocess
import time
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Callable, Optional

from evaluation.consumers.referee import Referee
from evaluation.consumers.run_recorder import RunRecorder
from evaluation.events import SUCCEEDED
from evaluation.map_truth import judge_map, score_against_world
from evaluation.options import LaunchPlan, MappingOptions
from evaluation.ros.run import Run
from evaluation.verdict import Verdict
from headless_mission.inputs import WorldInputs
from home_service.exploration_monitor import ExplorationMonitor
from planar import Pose2, SettingsError, load_map
from supervision.display import Display
from supervision.errors import LaunchError
from supervision.interruption import RunInterruptedError
from supervision.processes import ending_with_parent

# Time-outs for the map and for the whole program, which starts slowly on a busy machine [s].
MAP_SECONDS, SAVE_SECONDS = 30.0, 90.0
POLL_SECONDS = 0.05
# Drives the robot until the map is complete; returns why that failed, or None.
DriveFunction = Callable[[Run, ExplorationMonitor], Optional[str]]
TELEOP = ["rosrun", "teleop_lite", "turtlebot_teleop_key", "turtlebot_teleop_keyboard/cmd_vel:=cmd_vel"]


def make_map(options: MappingOptions, launch: LaunchPlan, drive: DriveFunction) -> int:
    """Run SLAM while ``drive`` drives the robot, and save the map; return the exit code."""
    _check_place_to_save(options.save)
    display = Display()
    referee = Referee({}, display.print)
    exploration = ExplorationMonitor(referee)
    with Run(options, launch, referee, RunRecorder({}), display, [exploration]) as run:
        failure = drive(run, exploration)
        path = save_map(run, options.save, failure)
        return run.conclude(Verdict(failure is None, failure or f"map saved in {path}"))


def make_scored_map(options: MappingOptions, launch: LaunchPlan, stage: WorldInputs) -> int:
    """Run SLAM and the explorer, save the map and score it against the world; return the exit code."""
    _check_place_to_save(options.save)
    display = Display()
    referee = Referee({}, display.print)
    exploration = ExplorationMonitor(referee)
    with Run(options, launch, referee, RunRecorder({}), display, [exploration]) as run:
        failure = explore(run, exploration)
        path = save_map(run, options.save, failure)
        distance_to_start = referee.distance_from(Pose2())
        score = score_against_world(load_map(path), stage.world, stage.robot)
        display.print(f"map saved in {path}")
        verdict = judge_map(score, distance_to_start, failure, referee.collision)
        return run.conclude(verdict, map=str(path), **asdict(score))


def explore(run: Run, exploration: ExplorationMonitor) -> Optional[str]:
    """Drive function: the explorer maps everything and returns to the start."""
    failure = run.watch(lambda: exploration.end is not None)
    if failure is not None or exploration.end is None:
        return failure
    run.display.print(f"{exploration.end.text}, {exploration.simulated_seconds:.0f} s simulated")
    return None if exploration.end.status == SUCCEEDED else exploration.end.text


def drive_by_keyboard(run: Run, _exploration: ExplorationMonitor) -> Optional[str]:
    """Drive function: the keyboard teleop owns the terminal or the pipe until it exits."""
    run.display.release_terminal()
    teleop = subprocess.Popen(TELEOP, preexec_fn=ending_with_parent())
    failure = run.watch(lambda: teleop.poll() is not None)
    if failure is None and teleop.returncode != 0:
        raise LaunchError(
            f"turtlebot_teleop_key exited with code {teleop.returncode}", is_bad_input=teleop.returncode == 2
        )
    return failure


def drive_in_browser(run: Run, _exploration: ExplorationMonitor) -> Optional[str]:
    """Drive function: a person drives in the cockpit until Ctrl-C."""
    run.display.print(f"ROS_MASTER_URI={os.environ['ROS_MASTER_URI']}")
    run.display.print("drive in the cockpit; Ctrl-C ends the run and saves the map")
    with suppress(RunInterruptedError):
        return run.watch(lambda: False)
    return None


def _check_place_to_save(stem: Optional[Path]) -> None:
    if stem and not stem.resolve().parent.is_dir():
        raise SettingsError(f"{stem.resolve().parent}: no such folder to save the map in")


def save_map(run: Run, stem: Optional[Path], failure: Optional[str] = None) -> Path:
    """Save the published map.

    Args:
        run: The run.
        stem: Path without suffix; None: into the run folder.
        failure: Why the run has failed before, to be reported first.

    Returns:
        Path of the YAML file.

    Raises:
        LaunchError: If the map cannot be saved.
    """
    stem = (stem or run.folder / "map").resolve()
    gap = _save(run, stem)
    if gap is not None:
        raise LaunchError("; ".join(filter(None, dict.fromkeys((failure, gap)))))
    return stem.with_name(stem.name + ".yaml")


def _save(run: Run, stem: Path) -> Optional[str]:
    """Return why the map was not saved, or None; map_saver alone would wait for a master for ever."""
    saver = subprocess.Popen(
        ["rosrun", "map_lite", "map_saver", "-f", str(stem), "--timeout", str(MAP_SECONDS)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
        preexec_fn=ending_with_parent(),
        text=True,
        errors="replace",
    )
    deadline = time.monotonic() + SAVE_SECONDS
    end_of_graph = None
    try:
        while saver.poll() is None and end_of_graph is None and time.monotonic() < deadline:
            time.sleep(POLL_SECONDS)
            end_of_graph = run.end_of_graph
    finally:
        is_late = saver.poll() is None
        saver.kill()
        output = saver.communicate()[0].split("\n")
    if saver.returncode == 0:
        return None
    last = next((line.strip() for line in reversed(output) if line.strip()), "")
    tail = f"; last line of its log: {last}" if last else ""
    failure = f"did not exit within {SAVE_SECONDS:g} s{tail}" if is_late else last or "failed"
    return end_of_graph or f"map_saver: {failure}"
