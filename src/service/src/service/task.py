"""A task: a request that was accepted, and how far it has come."""

import enum
from dataclasses import dataclass, replace
from typing import Any, Dict, Optional

from planar import Pose2
from service.requests.request import TaskRequest, request_to_json, to_millis
from service.requests.steps import PickUp, SetDown


class TaskStatus(enum.Enum):
    """Status of a task (Open-RMF: task_state.json)."""

    QUEUED = "queued"
    UNDERWAY = "underway"
    COMPLETED = "completed"
    FAILED = "failed"
    CANCELED = "canceled"
    SKIPPED = "skipped"
    """A repetition that was due while the robot was switched off."""


OPEN = (TaskStatus.QUEUED, TaskStatus.UNDERWAY)


@dataclass(frozen=True)
class ServiceTask:
    """A task.

    Attributes:
        id: Unique id.
        request: What was asked for.
        status: Its status.
        step: Number of completed steps.
        reason: Why it failed, was cancelled or waits; empty otherwise.
        started_at: Unix time of its first step [s]; None before.
        finished_at: Unix time of its end [s]; None before.
        step_started_at: Unix time at which a pause began [s]; None outside of one.
        attempts: Goals sent for it.
        interruptions: How often a more urgent task or charging interrupted it.
        series: Id of the series that it repeats; empty for a single one.
        estimate: Planned Unix time of its end [s]; None if it is not planned.
    """

    id: str
    request: TaskRequest
    status: TaskStatus = TaskStatus.QUEUED
    step: int = 0
    reason: str = ""
    started_at: Optional[float] = None
    finished_at: Optional[float] = None
    step_started_at: Optional[float] = None
    attempts: int = 0
    interruptions: int = 0
    series: str = ""
    estimate: Optional[float] = None

    @property
    def is_open(self) -> bool:
        """Whether something of it remains to be done."""
        return self.status in OPEN

    @property
    def is_carrying(self) -> bool:
        """Whether its object is on the robot."""
        if self.step == 0 or not self.request.object_name:
            return False
        done = self.request.description.steps()[: self.step]
        return any(isinstance(each, PickUp) for each in done) and not any(
            isinstance(each, SetDown) for each in done
        )

    @property
    def is_late(self) -> bool:
        """Whether it ended, or is planned to end, after its deadline."""
        end = self.finished_at if self.finished_at is not None else self.estimate
        return self.request.deadline is not None and end is not None and end > self.request.deadline

    def ended(self, status: TaskStatus, now: float, reason: str = "") -> "ServiceTask":
        """Return the task with its end."""
        return replace(self, status=status, finished_at=now, reason=reason, step_started_at=None)


@dataclass(frozen=True)
class Series:
    """A request that is repeated.

    Attributes:
        id: Unique id; the tasks of its repetitions are named after it.
        request: What is asked for each time.
        next_start: Unix time of its next repetition [s].
    """

    id: str
    request: TaskRequest
    next_start: float


@dataclass(frozen=True)
class ObjectState:
    """Where an object is.

    Attributes:
        place: Name of the place; None: not at a place.
        pose: Pose in the map where it stands or stood last; None if it is not known.
        carried_by: Id of the task for which it is on the robot; empty if it is not.
    """

    place: Optional[str]
    pose: Optional[Pose2] = None
    carried_by: str = ""

    @property
    def is_located(self) -> bool:
        """Whether it is known where it is."""
        return self.place is not None or self.pose is not None


def task_to_json(task: ServiceTask) -> Dict[str, Any]:
    """Return a task as JSON values, with the names of Open-RMF's task state."""
    request = request_to_json(task.request)
    booking = {
        name: request.pop(name)
        for name in ("priority", "unix_millis_request_time", "unix_millis_earliest_start_time", "labels")
        if name in request
    }
    requester = {"requester": request.pop("requester")} if "requester" in request else {}
    description = request.pop("description")
    steps = task.request.description.steps()
    document = {
        "booking": {"id": task.id, **booking, **requester},
        **request,
        "detail": description,
        "status": task.status.value,
        "unix_millis_start_time": to_millis(task.started_at),
        "unix_millis_finish_time": to_millis(task.finished_at),
        "unix_millis_expected_finish_time": to_millis(task.estimate) if task.is_open else None,
        "in_time": None if task.request.deadline is None else not task.is_late,
        "completed": list(range(task.step)),
        "active": task.step if task.status is TaskStatus.UNDERWAY else None,
        "pending": list(range(task.step, len(steps))) if task.is_open else [],
        "attempts": task.attempts,
        "interruptions": task.interruptions,
        "series": task.series or None,
        "reason": task.reason or None,
    }
    return {name: value for name, value in document.items() if value is not None}
