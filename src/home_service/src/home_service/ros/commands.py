"""The commands behind the scripts; each runs a graph to its end and returns an exit code."""

import os
from argparse import Namespace
from pathlib import Path
from typing import Dict, Set

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal

from home_service.judging.verdict import ARRIVAL_TOLERANCE, DEMO, ERRAND, MARKERS, OBJECTS, Verdict
from home_service.ros.following import FollowWatch
from home_service.ros.run import Run
from planar import Pose2
from planar_ros.calls.actions import goal_is_over, server_is_ready
from planar_ros.messages.conversion import pose2_to_msg


def launch(options: Namespace) -> int:
    with Run(options, "world.launch") as run:
        _tell_master(run)
        run.display.say("the home is open; Ctrl-C closes it")
        return _until_it_ends(run)


def test_navigation(options: Namespace) -> int:
    with Run(options, "navigation.launch", map_file=options.map.resolve()) as run:
        if options.goals is None:
            _tell_master(run)
            run.display.say("send goals to /move_base_simple/goal or to the action /move_base; Ctrl-C ends")
            return _until_it_ends(run)
        return run.conclude(_drive_through(run, [Pose2(*goal) for goal in options.goals]))


def pick_objects(options: Namespace) -> int:
    return _errand(options, "pick_objects.launch", {ERRAND})


def add_marker(options: Namespace) -> int:
    return _errand(options, "add_marker.launch", {DEMO})


def home_service(options: Namespace) -> int:
    expected = {ERRAND, OBJECTS} if options.mission else {ERRAND, MARKERS}
    arguments = {
        "marker_source": options.marker_source,
        "marker_mode": "mission" if options.mission or options.serve else "service",
        "serve": str(options.serve).lower(),
    }
    if not options.serve:
        return _errand(options, "home_service.launch", expected, **arguments)
    with Run(options, "home_service.launch", **_files(options), **arguments) as run:
        _tell_master(run)
        run.display.say("send missions to the action deliver; Ctrl-C ends")
        return _until_it_ends(run)


def follow(options: Namespace) -> int:
    with Run(options, "follow.launch", **_files(options)) as run:
        following = FollowWatch("follower")
        failure = run.watch(lambda: run.referee.ledger.is_complete({ERRAND}))
        run.referee.ledger.failure = failure or run.referee.ledger.failure
        verdict = run.judge({ERRAND})
        if verdict.success:
            complaint = following.complaint
            verdict = Verdict(complaint is None, complaint or f"{verdict.reason}; {following.praise}")
        return run.conclude(verdict, **following.findings())


def _errand(options: Namespace, launch_file: str, expected: Set[str], **arguments) -> int:
    with Run(options, launch_file, **_files(options), **arguments) as run:
        failure = run.watch(lambda: run.referee.ledger.is_complete(expected))
        run.referee.ledger.failure = failure or run.referee.ledger.failure
        return run.conclude(run.judge(expected))


def _files(options: Namespace) -> Dict[str, Path]:
    mission = getattr(options, "mission", None)
    files = {"map_file": options.map, "zones_file": options.zones, "mission_file": mission}
    return {name: path.resolve() for name, path in files.items() if path}


def _tell_master(run: Run) -> None:
    """What other terminals need to know."""
    run.display.say(f"ROS_MASTER_URI={os.environ['ROS_MASTER_URI']}")


def _until_it_ends(run: Run) -> int:
    return run.conclude(Verdict(False, run.watch(lambda: False) or ""))


def _drive_through(run: Run, goals) -> Verdict:
    client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
    failure = run.watch(lambda: server_is_ready(client))
    for number, pose in enumerate(goals, 1):
        if failure:
            return Verdict(False, failure)
        goal = MoveBaseGoal()
        goal.target_pose.header.frame_id = "map"
        goal.target_pose.header.stamp = rospy.Time.from_sec(run.referee.simulated_time)
        goal.target_pose.pose = pose2_to_msg(pose)
        client.send_goal(goal)
        failure = run.watch(lambda: goal_is_over(client))
        name = f"goal {number} ({pose.x:g}, {pose.y:g}, {pose.yaw:g})"
        if failure is None and client.get_state() != GoalStatus.SUCCEEDED:
            failure = f"{name}: {client.get_goal_status_text()}"
        failure = failure or run.watch_truth()
        if failure is None:
            error = run.referee.truth.distance_to(pose)
            run.display.say(f"{name}: reached, truly {error:.3f} m from it")
            if error > ARRIVAL_TOLERANCE:
                failure = f"{name}: the robot truly stood {error:.2f} m off"
    if failure is None and run.referee.ledger.collisions:
        failure = f"collided with {', '.join(sorted(set(run.referee.ledger.collisions)))}"
    return Verdict(failure is None, failure or f"{len(goals)} of {len(goals)} goals reached, no collision")
