"""Judges the record of a run: did the project reach its goals, or show its marker?"""

from typing import List, Optional, Sequence

from evaluation.verdict import Verdict
from run_project.judging.run_record import ProjectGoal, ProjectRunRecord, at_position, is_same_place

MAX_REPORTED_EVENTS = 8


def judge(
    record: ProjectRunRecord,
    failure: Optional[str] = None,
    requires_goals: bool = False,
    expected: Optional[Sequence[str]] = None,
) -> Verdict:
    """Judge a run: success if all goals were reached or, without goals, if the project showed a marker.

    A failed goal that was sent again and reached does not count, nor do goals after two rounds of the same
    positions.

    Args:
        record: Goals and markers of the run.
        failure: Why the run was cut short, if it was.
        requires_goals: Whether a marker without a goal is a failure.
        expected: Expected final status of each goal, instead of success.
    """
    goals = list(record.goals.values())[: record.goals_of_two_rounds or None]
    reached = sum(goal.is_reached for goal in goals)
    failed = [
        f"goal {number}{at_position(goal.place)} {goal.status}{f' ({goal.text})' if goal.text else ''}"
        for number, goal in enumerate(goals, 1)
        if not goal.is_reached and not _was_reached_later(goal, goals[number:])
    ]
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
    if goals:
        return Verdict(True, f"{reached} of {len(goals)} goals reached; {summary}")
    return Verdict(bool(record.markers) and not requires_goals, f"no goal sent; {summary}")


def _shortened(events: List[str]) -> List[str]:
    """Shorten a list of events by its middle, as for a marker that moves with the robot."""
    if len(events) <= MAX_REPORTED_EVENTS:
        return events
    half = MAX_REPORTED_EVENTS // 2
    return [*events[:half], f"... {len(events) - MAX_REPORTED_EVENTS} more ...", *events[-half:]]


def _was_reached_later(goal: ProjectGoal, later: List[ProjectGoal]) -> bool:
    return any(other.is_reached and is_same_place(goal, other) for other in later)
