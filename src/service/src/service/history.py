"""Figures of a service from its journal."""

import math
from dataclasses import dataclass
from statistics import median
from typing import Dict, List, Sequence

from service.requests.calendar_times import clock_text
from service.task import ServiceTask, TaskStatus


@dataclass(frozen=True)
class HistoryFigures:
    """Figures of tasks that have ended.

    Attributes:
        counts: Number of tasks by status.
        with_deadline: Number of tasks with a deadline.
        in_time: Number of those that were done by it.
        wait: Median time from the request, or its earliest start, to the first step [s].
        duration: Median time from the first step to the end [s].
        interruptions: Number of interruptions.
        reasons: Number of tasks by the reason why they were not done.
    """

    counts: Dict[str, int]
    with_deadline: int
    in_time: int
    wait: float
    duration: float
    interruptions: int
    reasons: Dict[str, int]


def figures_of(tasks: Sequence[ServiceTask]) -> HistoryFigures:
    """Return the figures of tasks that have ended."""
    counts: Dict[str, int] = {}
    reasons: Dict[str, int] = {}
    for task in tasks:
        counts[task.status.value] = counts.get(task.status.value, 0) + 1
        if task.reason:
            reasons[task.reason] = reasons.get(task.reason, 0) + 1
    due = [task for task in tasks if task.request.deadline is not None]
    done = TaskStatus.COMPLETED
    waits = [task.started_at - task.request.release for task in tasks if task.started_at is not None]
    durations = [
        task.finished_at - task.started_at
        for task in tasks
        if task.started_at is not None and task.finished_at is not None
    ]
    return HistoryFigures(
        counts,
        len(due),
        sum(task.status is done and not task.is_late for task in due),
        median(waits) if waits else math.nan,
        median(durations) if durations else math.nan,
        sum(task.interruptions for task in tasks),
        reasons,
    )


def history_lines(tasks: Sequence[ServiceTask]) -> List[str]:
    """Return one line for each task, for people."""
    return [_line(task) for task in tasks]


def figure_lines(figures: HistoryFigures) -> List[str]:
    """Return the figures for people."""
    counts = ", ".join(f"{count} {name}" for name, count in figures.counts.items()) or "no task has ended"
    lines = [counts]
    if figures.with_deadline:
        lines.append(f"in time: {figures.in_time} of {figures.with_deadline}")
    if not math.isnan(figures.wait):
        lines.append(f"median wait {figures.wait:.0f} s, median duration {figures.duration:.0f} s")
    lines.append(f"interruptions: {figures.interruptions}")
    most = sorted(figures.reasons.items(), key=lambda item: -item[1])[:5]
    return [*lines, *(f"{count} x {reason}" for reason, count in most)]


def _line(task: ServiceTask) -> str:
    late = ", late" if task.is_late else ""
    reason = f" ({task.reason})" if task.reason else ""
    at = clock_text(task.finished_at or 0.0)
    return f"{at}  {task.id:>8}  {task.status.value}{late}{reason}  {task.request.description.text}"
