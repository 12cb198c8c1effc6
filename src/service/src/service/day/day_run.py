"""Runs days of service event by event."""

from dataclasses import dataclass, field
from typing import Callable, List, Optional, Sequence

from service.day.kinematic_robot import KinematicRobot
from service.execution.robot import RobotEvent, RobotInputs, RobotOrder
from service.request_service import RequestService
from service.requests.timed_requests import RequestFeed, TimedRequest
from service.task import ServiceTask, TaskStatus
from service.task_book import Changes, JournalEntry

Store = Callable[[Changes, int], None]
# Shortest time between two calls of the service [s].
TICK = 0.5


@dataclass
class DayRecord:
    """What came of the requests.

    Attributes:
        ended: Tasks that have ended.
        refused: Reasons of refused requests.
        log: Entries of the service's log.
        lowest_charge: Lowest charge of the battery, 0 to 1.
        calls: Number of calls of the service.
    """

    ended: List[ServiceTask] = field(default_factory=list)
    refused: List[str] = field(default_factory=list)
    log: List[JournalEntry] = field(default_factory=list)
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


class RecordedService:
    """A service that receives the requests of a day when they come, and a record of what comes of them.

    Args:
        service: The service.
        requests: Requests in the order of their stamps.
        record: Receives what happens.
        store: Called with what changed after each call, before an order is carried out.
    """

    def __init__(
        self,
        service: RequestService,
        requests: Sequence[TimedRequest],
        record: DayRecord,
        store: Store = lambda changes, number: None,
    ):
        self._service, self._record, self._store = service, record, store
        self._feed = RequestFeed(requests, service.submit, record.refused.append)

    def advance(self, now: float, robot: RobotInputs, event: Optional[RobotEvent]) -> Optional[RobotOrder]:
        """Submit the requests that have come, advance the service and return its order.

        Args:
            now: Unix time [s].
            robot: State of the robot.
            event: What happened to the last order, if there is news.
        """
        self._feed.advance(now)
        record = self._record
        record.lowest_charge = min(record.lowest_charge, robot.charge or 0.0)
        record.calls += 1
        order = self._service.advance(now, robot, event)
        changes = self._service.take_changes()
        if changes:
            self._store(changes, self._service.book.next_number)
            record.ended += [task for task in changes.tasks.values() if not task.is_open]
            record.log += changes.log
        return order

    def wakes_at(self, now: float) -> float:
        """Return when the service has to be called again, without news of the robot: Unix time [s]."""
        return min(self._service.wakes_at(now), self._feed.next_stamp)

    def activity(self, now: float) -> str:
        """Return what the robot does."""
        return str(self._service.state(now)["activity"])


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
        store: Store = lambda changes, number: None,
    ):
        self.record = DayRecord()
        self._service = RecordedService(service, requests, self.record, store)
        self._robot, self._now = robot, start

    def run(self, until: float) -> DayRecord:
        """Run to a Unix time [s]."""
        while self._now < until:
            event = self._robot.event(self._now)
            order = self._service.advance(self._now, self._robot.inputs(self._now), event)
            self._robot.carry_out(order, self._now)
            due = self._now if order is not None else self._next_time()
            self._now = max(self._now + TICK, due)
        return self.record

    def _next_time(self) -> float:
        return min(self._service.wakes_at(self._now), self._robot.next_event)


def kept_share(record: DayRecord) -> Optional[float]:
    """Return the share of deadlines that were kept; None without deadlines."""
    return len(record.kept) / len(record.with_deadline) if record.with_deadline else None
