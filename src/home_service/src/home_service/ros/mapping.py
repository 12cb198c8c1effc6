"""Maps made by hand, or by a robot that explores the world."""

import os
import subprocess
import time
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Callable, List, Optional

from actionlib_msgs.msg import GoalStatus
from home_service_msgs.msg import ExploreActionFeedback, ExploreActionResult

from home_service.inputs import WorldInputs
from home_service.judging.map_truth import judge_map, score_against_world
from home_service.judging.verdict import Verdict
from home_service.options import LaunchPlan, MappingOptions
from home_service.ros.referee import Referee
from home_service.ros.run import Run
from home_service.ros.run_recorder import RunRecorder
from home_service.ros.subscription import subscribe
from planar import Pose2, SettingsError, load_map
from supervision.display import Display
from supervision.errors import LaunchError
from supervision.interruption import RunInterruptedError
from supervision.processes import ending_with_parent

# For the map to come, and for all of it: on a machine that is busy a program takes long to start.
MAP_SECONDS, SAVE_SECONDS = 30.0, 90.0
POLL_SECONDS = 0.05
# Has the robot driven until the map is made; why that failed, or None.
Driver = Callable[[Run, Referee], Optional[str]]
TELEOP = ["rosrun", "teleop_lite", "turtlebot_teleop_key", "turtlebot_teleop_keyboard/cmd_vel:=cmd_vel"]


def make_map(options: MappingOptions, launch: LaunchPlan, drive: Driver) -> int:
    """Runs SLAM while ``drive`` does, and saves the map; returns the exit code."""
    _check_place_to_save(options.save)
    display = Display()
    referee = Referee({}, display.print)
    with Run(options, launch, referee, RunRecorder({}), display) as run:
        failure = drive(run, referee)
        path = save_map(run, options.save, failure)
        return run.conclude(Verdict(failure is None, failure or f"map saved in {path}"))


def make_scored_map(options: MappingOptions, launch: LaunchPlan, stage: WorldInputs) -> int:
    """Runs SLAM and the explorer, saves the map, and judges it by the world; returns the exit code."""
    _check_place_to_save(options.save)
    display = Display()
    referee = Referee({}, display.print)
    with Run(options, launch, referee, RunRecorder({}), display) as run:
        failure = explore(run, referee)
        path = save_map(run, options.save, failure)
        distance_to_start = referee.distance_from(Pose2())
        score = score_against_world(load_map(path), stage.world, stage.robot)
        display.print(f"map saved in {path}")
        verdict = judge_map(score, distance_to_start, failure, referee.collision)
        return run.conclude(verdict, map=str(path), **asdict(score))


def explore(run: Run, referee: Referee) -> Optional[str]:
    """A driver: the robot explores by itself and returns."""

    def show(message: ExploreActionFeedback) -> None:
        told = message.feedback
        referee.state = f"{told.state}, {told.explored_area:.0f} m2 known, {told.frontiers} frontiers"

    ends: List[GoalStatus] = []
    subscribe("explore/feedback", ExploreActionFeedback, show)
    subscribe("explore/result", ExploreActionResult, lambda message: ends.append(message.status))
    failure = run.watch(lambda: len(ends) > 0)
    if failure is not None:
        return failure
    run.display.print(f"{ends[0].text}, {referee.simulated_seconds:.0f} s simulated")
    return None if ends[0].status == GoalStatus.SUCCEEDED else ends[0].text


def drive_by_keyboard(run: Run, _referee: Referee) -> Optional[str]:
    """A driver: terminal or pipe are left to the keyboard teleop until it ends."""
    run.display.release_terminal()
    teleop = subprocess.Popen(TELEOP, preexec_fn=ending_with_parent())
    failure = run.watch(lambda: teleop.poll() is not None)
    if failure is None and teleop.returncode != 0:
        raise LaunchError("the keyboard teleop has failed", is_bad_input=teleop.returncode == 2)
    return failure


def drive_in_browser(run: Run, _referee: Referee) -> Optional[str]:
    """A driver: a person drives in the browser until Ctrl-C."""
    run.display.print(f"ROS_MASTER_URI={os.environ['ROS_MASTER_URI']}")
    run.display.print("drive at the page; Ctrl-C ends, and saves the map")
    with suppress(RunInterruptedError):
        return run.watch(lambda: False)
    return None


def _check_place_to_save(stem: Optional[Path]) -> None:
    if stem and not stem.resolve().parent.is_dir():
        raise SettingsError(f"{stem.resolve().parent}: no such folder to save the map in")


def save_map(run: Run, stem: Optional[Path], failure: Optional[str] = None) -> Path:
    """Saves the map that is published, into the run folder if no ``stem`` is given; returns its YAML.

    Raises LaunchError, which first tells the ``failure`` that the run has come to before.
    """
    stem = (stem or run.folder / "map").resolve()
    gap = _save(run, stem)
    if gap is not None:
        raise LaunchError("; ".join(filter(None, dict.fromkeys((failure, gap)))))
    return stem.with_name(stem.name + ".yaml")


def _save(run: Run, stem: Path) -> Optional[str]:
    """Why there is no map, or None. Without a master the saver would wait for ever."""
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
        said = saver.communicate()[0].split("\n")
    if saver.returncode == 0:
        return None
    last = next((line.strip() for line in reversed(said) if line.strip()), "")
    words = f"; its last words: {last}" if last else ""
    failure = f"not over after {SAVE_SECONDS:g} s{words}" if is_late else last or "failed"
    return end_of_graph or f"map_saver: {failure}"
