"""Runs days of service event by event."""

import math
from dataclasses import dataclass, field
from typing import Callable, List, Optional, Sequence

from service.day.kinematic_robot import KinematicRobot
from service.day.requests_by_hour import TimedRequest
from service.errors import QueueFullError, RequestError
from service.request_service import RequestService
from service.task import ServiceTask, TaskStatus
from service.task_book import Changes

# Shortest time between two calls of the service [s].
TICK = 0.5


@dataclass
class DayRecord:
    """What came of the requests.

    Attributes:
        ended: Tasks that have ended.
        refused: Reasons of refused requests.
        lowest_charge: Lowest charge of the battery, 0 to 1.
        calls: Number of calls of the service.
    """

    ended: List[ServiceTask] = field(default_factory=list)
    refused: List[str] = field(default_factory=list)
    lowest_charge: float = 1.0
    calls: int = 0

    @property
    def with_deadline(self) -> List[ServiceTask]:
        """Tasks with a deadline."""
        return [task for task in self.ended if task.request.deadline is not None]

    @property
    def kept(self) -> List[ServiceTask]:
        """Tasks with a deadline that were done in time."""
        done = TaskStatus.COMPLETED
        return [task for task in self.with_deadline if task.status is done and not task.is_late]


class DayRun:
    """A service, its robot and the requests that come.

    Args:
        service: The service.
        robot: Carries out its orders.
        requests: Requests in the order of their stamps.
        start: Unix time of the begin [s].
        store: Called with what changed after each call, before an order is carried out.
    """

    def __init__(
        self,
        service: RequestService,
        robot: KinematicRobot,
        requests: Sequence[TimedRequest],
        start: float,
        store: Callable[[Changes, int], None] = lambda changes, number: None,
    ):
        self._service, self._robot, self._requests = service, robot, list(requests)
        self._now, self._store, self._next = start, store, 0
        self.record = DayRecord()

    def run(self, until: float) -> DayRecord:
        """Run to a Unix time [s]."""
        while self._now < until:
            self._submit_due()
            event = self._robot.event(self._now)
            inputs = self._robot.inputs(self._now)
            self.record.lowest_charge = min(self.record.lowest_charge, inputs.charge or 0.0)
            order = self._service.advance(self._now, inputs, event)
            self._keep_changes()
            self._robot.carry_out(order, self._now)
            self.record.calls += 1
            self._now = self._now + TICK if order is not None else max(self._now + TICK, self._next_time())
        return self.record

    def _next_time(self) -> float:
        due = self._requests[self._next].stamp if self._next < len(self._requests) else math.inf
        return min(self._service.wakes_at(self._now), self._robot.next_event, due)

    def _submit_due(self) -> None:
        while self._next < len(self._requests) and self._requests[self._next].stamp <= self._now:
            document = self._requests[self._next].document
            self._next += 1
            try:
                self._service.submit(document, self._now)
            except (RequestError, QueueFullError) as error:
                self.record.refused.append(str(error))

    def _keep_changes(self) -> None:
        changes = self._service.take_changes()
        if changes:
            self._store(changes, self._service.book.next_number)
            self.record.ended += [task for task in changes.tasks.values() if not task.is_open]


def kept_share(record: DayRecord) -> Optional[float]:
    """Return the share of deadlines that were kept; None without deadlines."""
    return len(record.kept) / len(record.with_deadline) if record.with_deadline else None
