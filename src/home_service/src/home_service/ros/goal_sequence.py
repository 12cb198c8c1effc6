"""Drive to goals of move_base one after the other, judged by ground truth."""

from typing import Optional, Sequence

import rospy

from evaluation.consumers.referee import Referee
from evaluation.consumers.run_recorder import RunRecorder
from evaluation.event_stream import Latest
from evaluation.events import GoalEnded
from evaluation.options import LaunchPlan, RunOptions
from evaluation.ros.run import Run
from evaluation.verdict import ARRIVAL_TOLERANCE, Verdict
from planar import Pose2
from planar.driving import DriveOutcome, DriveResult
from planar_ros.calls.move_base import MoveBaseClient
from supervision.display import Display


def drive_to_goals(options: RunOptions, launch: LaunchPlan, goals: Sequence[Pose2]) -> int:
    """Run a navigation graph and drive to goals in the map frame; return the exit code."""
    display = Display()
    referee = Referee({}, display.print)
    end = Latest(GoalEnded)
    with Run(options, launch, referee, RunRecorder({}), display, [end]) as run:
        failure = _drive_to_all(run, referee, end, goals) or referee.collision
        reached = f"{len(goals)} of {len(goals)} goals reached, no collision"
        return run.conclude(Verdict(failure is None, failure or reached))


def _drive_to_all(
    run: Run, referee: Referee, end: "Latest[GoalEnded]", goals: Sequence[Pose2]
) -> Optional[str]:
    """Return why the last goal was not reached, or None."""
    # Created after the run has subscribed, so that ``end`` is known before the client knows the outcome.
    move_base = MoveBaseClient()
    failure = run.watch(move_base.is_ready)
    for number, pose in enumerate(goals, 1):
        if failure is None:
            name = f"goal {number} ({pose.x:g}, {pose.y:g}, {pose.yaw:g})"
            failure = _drive_to(run, referee, move_base, pose, name)
            failure = failure or run.watch(
                lambda: end.event is None or referee.simulated_time >= end.event.stamp
            )
            failure = failure or _judged(run, referee, pose, name)
    return failure


def _drive_to(run: Run, referee: Referee, move_base: MoveBaseClient, pose: Pose2, name: str) -> Optional[str]:
    outcome: Optional[DriveOutcome] = None

    def is_over() -> bool:
        nonlocal outcome
        outcome = move_base.outcome()
        return outcome is not None

    move_base.send(pose, rospy.Time.from_sec(referee.simulated_time))
    failure = run.watch(is_over)
    if outcome is not None and outcome.result is not DriveResult.REACHED:
        failure = f"{name}: {outcome.text}"
    return failure


def _judged(run: Run, referee: Referee, pose: Pose2, name: str) -> Optional[str]:
    """Return how far the robot truly is from a goal that it has reached, if too far."""
    error = referee.distance_from(pose)
    run.display.print(f"{name}: reached, truly {error:.3f} m from it")
    return f"{name}: the robot truly stood {error:.2f} m off" if error > ARRIVAL_TOLERANCE else None
