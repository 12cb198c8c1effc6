"""Judges the record of a run: did the project reach its goals, or show its marker?"""

from dataclasses import dataclass
from typing import List, Optional, Sequence

from run_project.judging.run_record import ProjectGoal, ProjectRunRecord, at_position, is_same_place

MAX_REPORTED_EVENTS = 8


@dataclass(frozen=True)
class ProjectVerdict:
    """Whether a run succeeded, and why."""

    success: bool
    reason: str


def judge(
    record: ProjectRunRecord,
    failure: Optional[str] = None,
    requires_goals: bool = False,
    expected: Optional[Sequence[str]] = None,
) -> ProjectVerdict:
    """Success if the robot reached all places it was sent to; without goals, if the project showed a marker.

    A goal that failed and was sent again does not count, nor do those of a third round of the same places.
    ``failure``: why the run was cut short, if it was. ``is_errand``: markers alone are not enough.
    ``expected``: how the goals have to end instead, one after the other.
    """
    goals = list(record.goals.values())[: record.goals_of_two_rounds or None]
    reached = sum(goal.is_reached for goal in goals)
    failed = [
        f"goal {number}{at_position(goal.place)} {goal.status}{f' ({goal.text})' if goal.text else ''}"
        for number, goal in enumerate(goals, 1)
        if not goal.is_reached and not _was_reached_later(goal, goals[number:])
    ]
    if failure:
        return ProjectVerdict(False, f"{failure}; {reached} of {len(goals)} goals reached")
    if expected is not None:
        endings = [goal.status for goal in goals]
        is_so = endings == list(expected)
        said = "as expected" if is_so else f"instead of {', '.join(expected)}"
        story = f"{', '.join(endings) or 'none'}, {said}"
        return ProjectVerdict(is_so, f"{reached} of {len(goals)} goals reached; {story}")
    if failed:
        return ProjectVerdict(False, f"{reached} of {len(goals)} goals reached; {'; '.join(failed)}")
    story = f"markers: {', '.join(_shortened(record.markers))}" if record.markers else "no marker shown"
    if goals:
        return ProjectVerdict(True, f"{reached} of {len(goals)} goals reached; {story}")
    return ProjectVerdict(bool(record.markers) and not requires_goals, f"no goal sent; {story}")


def _shortened(events: List[str]) -> List[str]:
    """Without the middle, where a marker went with the robot."""
    if len(events) <= MAX_REPORTED_EVENTS:
        return events
    half = MAX_REPORTED_EVENTS // 2
    return [*events[:half], f"... {len(events) - MAX_REPORTED_EVENTS} more ...", *events[-half:]]


def _was_reached_later(goal: ProjectGoal, later: List[ProjectGoal]) -> bool:
    return any(other.is_reached and is_same_place(goal, other) for other in later)
