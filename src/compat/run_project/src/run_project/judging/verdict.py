"""Judges the record of a run: did the project reach its goals, or show its marker?"""

from typing import List, Optional, Sequence

from evaluation.verdict import Verdict
from run_project.judging.run_record import (
    FINAL_STATUSES,
    ProjectGoal,
    ProjectRunRecord,
    at_position,
    is_same_place,
)

MAX_REPORTED_EVENTS = 8
# Fraction of goals that a project without an end has to reach: goals at random places may be in walls.
ENOUGH_REACHED = 0.8
# Distance that a project without goals has to drive [m].
LEAST_DRIVE = 1.0


def judge(
    record: ProjectRunRecord,
    failure: Optional[str] = None,
    requires_goals: bool = False,
    expected: Optional[Sequence[str]] = None,
    time_limit: Optional[float] = None,
) -> Verdict:
    """Judge a run: success if all goals were reached or, without goals, if it showed a marker or drove.

    A failed goal that was sent again and reached does not count, nor do goals after two rounds of the same
    positions. A project that works until the time limit, as one that patrols, succeeds if it reached most of
    its goals; one that sends none, if the robot drove.

    Args:
        record: Goals and markers of the run.
        failure: Why the run was cut short, if it was.
        requires_goals: Whether this is a home-service mission: its goals have to be reached, and its object
            has to move.
        expected: Expected final status of each goal, instead of success.
        time_limit: The limit of wall time, if the run was cut short by it [s].
    """
    goals = list(record.goals.values())[: record.goals_of_two_rounds or None]
    reached = sum(goal.is_reached for goal in goals)
    failed = [
        f"goal {number}{at_position(goal.place)} {goal.status}{f' ({goal.text})' if goal.text else ''}"
        for number, goal in enumerate(goals, 1)
        if not goal.is_reached and not _was_reached_later(goal, goals[number:])
    ]
    if time_limit is not None:
        return _judge_at_time_limit(record, time_limit, requires_goals or expected is not None)
    if failure:
        return Verdict(False, f"{failure}; {reached} of {len(goals)} goals reached")
    if expected is not None:
        endings = [goal.status for goal in goals]
        is_expected = endings == list(expected)
        comparison = "as expected" if is_expected else f"instead of {', '.join(expected)}"
        summary = f"{', '.join(endings) or 'none'}, {comparison}"
        return Verdict(is_expected, f"{reached} of {len(goals)} goals reached; {summary}")
    if failed:
        return Verdict(False, f"{reached} of {len(goals)} goals reached; {'; '.join(failed)}")
    summary = f"markers: {', '.join(_shortened(record.markers))}" if record.markers else "no marker shown"
    if len(goals) > 1 and requires_goals and record.is_object_never_moved:
        summary += (
            "; it was neither hidden at the pick-up nor shown elsewhere: see the log of the marker's node"
        )
        return Verdict(False, f"{reached} of {len(goals)} goals reached; {summary}")
    if goals:
        return Verdict(True, f"{reached} of {len(goals)} goals reached; {summary}")
    if record.distance_driven > LEAST_DRIVE and not requires_goals:
        return Verdict(True, f"no goal sent; {record.distance_driven:.1f} m driven; {summary}")
    return Verdict(bool(record.markers) and not requires_goals, f"no goal sent; {summary}")


def _judge_at_time_limit(record: ProjectRunRecord, limit: float, has_to_end: bool) -> Verdict:
    """Judge a project that did not end by what it has done so far; the goal that is active does not count."""
    ended = [goal for goal in record.goals.values() if goal.status in FINAL_STATUSES]
    reached = sum(goal.is_reached for goal in ended)
    done = f"{reached} of {len(ended)} goals reached, {record.distance_driven:.1f} m driven"
    if not record.is_busy:
        return Verdict(False, f"not done within {limit:g} s of wall time; {done}; nothing moved at the end")
    if has_to_end:
        return Verdict(
            False, f"not done within {limit:g} s of wall time; {done}; a longer --timeout may help"
        )
    is_good = reached >= ENOUGH_REACHED * len(ended) if ended else record.distance_driven > LEAST_DRIVE
    return Verdict(is_good, f"still running after {limit:g} s of wall time; {done}")


def _shortened(events: List[str]) -> List[str]:
    """Shorten a list of events by its middle, as for a marker that moves with the robot."""
    if len(events) <= MAX_REPORTED_EVENTS:
        return events
    half = MAX_REPORTED_EVENTS // 2
    return [*events[:half], f"... {len(events) - MAX_REPORTED_EVENTS} more ...", *events[-half:]]


def _was_reached_later(goal: ProjectGoal, later: List[ProjectGoal]) -> bool:
    return any(other.is_reached and is_same_place(goal, other) for other in later)
