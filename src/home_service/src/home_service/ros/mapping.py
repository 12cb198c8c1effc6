"""The commands that map a world: by hand, or by a robot that explores it, with a score against the truth."""

import subprocess
from argparse import Namespace
from dataclasses import asdict
from pathlib import Path
from typing import Optional

import actionlib
from actionlib_msgs.msg import GoalStatus
from home_service_msgs.msg import ExploreAction, ExploreGoal

from home_service.judging.map_truth import LEAST_PRECISION, LEAST_RECALL, score_against_world
from home_service.judging.verdict import ARRIVAL_TOLERANCE, Verdict
from home_service.ros.run import Run
from planar import Pose2, SettingsError, load_map
from planar.maps.map_score import MapScore
from planar_ros.calls.actions import goal_is_over, server_is_ready
from supervision.errors import LaunchError

SAVE_SECONDS = 30.0
TELEOP = ["rosrun", "teleop_lite", "turtlebot_teleop_key", "turtlebot_teleop_keyboard/cmd_vel:=cmd_vel"]


def test_slam(options: Namespace) -> int:
    by_itself = options.drive == "auto"
    if not by_itself and "speed" not in options:
        options.speed = 1.0
    _check_place_to_save(options)
    with Run(options, "mapping.launch" if by_itself else "slam.launch") as run:
        failure = _explore(run) if by_itself else _drive_by_keys(run)
        path = save_map(run, options.save)
        return run.conclude(Verdict(failure is None, failure or f"map saved in {path}"))


def map_home(options: Namespace) -> int:
    _check_place_to_save(options)
    with Run(options, "mapping.launch") as run:
        failure = _explore(run)
        path = save_map(run, options.save)
        way_home = run.referee.truth.distance_to(Pose2())
        score = score_against_world(load_map(path), options.loaded_world, options.loaded_robot)
        run.display.say(f"map saved in {path}")
        return run.conclude(_judge(failure, run, score, way_home), map=str(path), **asdict(score))


def _explore(run: Run) -> Optional[str]:
    """Has the robot explore and return; why that failed, or None."""
    client = actionlib.SimpleActionClient("explore", ExploreAction)
    failure = run.watch(lambda: server_is_ready(client))
    if failure:
        return failure

    def show(feedback):
        run.referee.state = (
            f"{feedback.state}, {feedback.explored_area:.0f} m2 known, {feedback.frontiers} frontiers"
        )

    client.send_goal(ExploreGoal(return_to_start=True), feedback_cb=show)
    failure = run.watch(lambda: goal_is_over(client))
    if failure is None and client.get_state() != GoalStatus.SUCCEEDED:
        failure = client.get_goal_status_text()
    run.display.say(f"{client.get_goal_status_text()}, {run.referee.simulated_seconds:.0f} s simulated")
    return failure


def _drive_by_keys(run: Run) -> Optional[str]:
    """Leaves terminal or pipe to the keyboard teleop until it ends; why the run cannot go on, or None."""
    run.display.hush()
    teleop = subprocess.Popen(TELEOP)
    failure = run.watch(lambda: teleop.poll() is not None)
    if failure is None and teleop.returncode != 0:
        raise LaunchError("the keyboard teleop has failed", is_bad_input=teleop.returncode == 2)
    return failure


def _check_place_to_save(options: Namespace) -> None:
    if options.save and not options.save.resolve().parent.is_dir():
        raise SettingsError(f"{options.save.resolve().parent}: no such folder to save the map in")


def save_map(run: Run, stem: Optional[Path]) -> Path:
    """Saves the map that is published, into the run folder if no ``stem`` is given; returns its YAML."""
    stem = (stem or run.folder / "map").resolve()
    saver = subprocess.run(
        ["rosrun", "map_lite", "map_saver", "-f", str(stem)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        timeout=SAVE_SECONDS,
        text=True,
        check=False,
    )
    if saver.returncode != 0:
        raise LaunchError(f"map_saver: {' '.join(saver.stderr.split()) or 'failed'}")
    return stem.with_name(stem.name + ".yaml")


def _judge(failure: Optional[str], run: Run, score: MapScore, way_home: float) -> Verdict:
    collisions = run.referee.ledger.collisions
    complaints = [
        (failure is not None, failure),
        (way_home > ARRIVAL_TOLERANCE, f"the robot truly stands {way_home:.2f} m from where it started"),
        (score.recall < LEAST_RECALL, f"recall below {LEAST_RECALL}"),
        (score.precision < LEAST_PRECISION, f"precision below {LEAST_PRECISION}"),
        (score.doubled_walls > 0, "walls are doubled"),
        (bool(collisions), f"collided with {', '.join(sorted(set(collisions)))}"),
    ]
    figures = (
        f"recall {score.recall:.3f}, precision {score.precision:.3f}, {score.doubled_walls} doubled walls, "
        f"back {way_home:.2f} m from the start"
    )
    reasons = [text for is_wrong, text in complaints if is_wrong]
    return Verdict(not reasons, f"{'; '.join(reasons)} ({figures})" if reasons else figures)
