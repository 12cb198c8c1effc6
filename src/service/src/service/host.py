"""The service with its journal, in one thread; other threads hand over what they want of it."""

import queue
import time
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Tuple

from planar import PlanarError
from service.errors import JournalError
from service.execution.robot import RobotEvent, RobotInputs, RobotOrder, StopRobot
from service.journal import Journal, JournalLimits
from service.request_service import RequestService
from service.task import Series, ServiceTask, task_to_json
from service.task_book import JournalEntry

# Wall-clock time between two attempts to write a journal that could not be written [s].
RETRY_SECONDS = 2.0
# Calls that are answered in one cycle; further ones wait for the next.
MAX_CALLS = 500

# Acts on the service at a Unix time; what it returns is called after planning, for the answer.
Act = Callable[["ServiceHost", float], Callable[[], Any]]
Listener = Callable[[int, JournalEntry], object]


@dataclass(frozen=True)
class Call:
    """A call from another thread.

    Attributes:
        act: What is to be done.
        answer: Receives the answer, once it is in the journal.
    """

    act: Act
    answer: "Future[Any]"


class ServiceHost:
    """Restores a service from its journal, and stores its changes before anything is done or answered.

    If the journal cannot be written, the service is discarded, the robot stops, and the service is restored
    once the journal can be written again.

    Args:
        path: File of the journal.
        make: Makes the service from the journal's content.
        log: Called with warnings for people.
        limits: Bounds of the journal.

    Attributes:
        journal: The journal; None while it cannot be written.
        service: The service; None while its journal cannot be written.
        problem: Why there is no service; empty if there is one.

    Raises:
        JournalError: If the journal cannot be read or written.
    """

    def __init__(
        self,
        path: Path,
        make: Callable[[Journal], RequestService],
        log: Callable[[str], None] = lambda text: None,
        limits: JournalLimits = JournalLimits(),
    ):
        self._path, self._make, self._log, self._limits = path, make, log, limits
        self._calls: queue.SimpleQueue[Call] = queue.SimpleQueue()
        self._listeners: Dict[int, Listener] = {}
        self.problem, self._retry_at = "", 0.0
        self.journal: Optional[Journal] = None
        self.service: Optional[RequestService] = None
        self._open()

    def call(self, act: Act) -> "Future[Any]":
        """Have something done in the service's thread; for any thread."""
        call = Call(act, Future())
        self._calls.put(call)
        return call.answer

    def listen(self, key: int, listener: Optional[Listener]) -> None:
        """Add a listener for entries of the log, or remove it; to be called in the service's thread."""
        if listener is None:
            self._listeners.pop(key, None)
        else:
            self._listeners[key] = listener

    def cycle(
        self, now: float, robot: RobotInputs, event: Optional[RobotEvent] = None
    ) -> Optional[RobotOrder]:
        """Answer calls and advance the service; the order is in the journal when it is returned.

        Args:
            now: Unix time [s].
            robot: State of the robot.
            event: What happened to the last order, if there is news.
        """
        calls = self._waiting_calls()
        if self.service is None and not self._reopen():
            self._refuse(calls)
            return None
        assert self.service is not None
        answers = [(call, *self._act(call, now)) for call in calls]
        if calls:
            self.service.plan(now)
        order = self.service.advance(now, robot, event)
        try:
            self._store()
        except JournalError as error:
            self._give_up(error)
            self._refuse(calls)
            return StopRobot()
        for call, answer, problem in answers:
            if call.answer.set_running_or_notify_cancel():
                _give(call.answer, answer, problem)
        return order

    def close(self) -> None:
        """Close the journal."""
        if self.journal is not None:
            self.journal.close()

    def describe(self, task_id: str) -> Dict[str, Any]:
        """Return a task or a series as JSON values.

        Raises:
            UnknownTaskError: If there is none of that id.
        """
        assert self.service is not None
        series = self.service.book.series.get(task_id)
        return series_to_json(series) if series is not None else task_to_json(self.service.find(task_id))

    def _waiting_calls(self) -> List[Call]:
        calls: List[Call] = []
        while len(calls) < MAX_CALLS:
            try:
                calls.append(self._calls.get_nowait())
            except queue.Empty:
                break
        return calls

    def _act(self, call: Call, now: float) -> Tuple[Callable[[], Any], Optional[PlanarError]]:
        try:
            return call.act(self, now), None
        except PlanarError as error:
            return (lambda: None), error

    def _store(self) -> None:
        assert self.service is not None and self.journal is not None
        changes = self.service.take_changes()
        if not changes:
            return
        latest = self.journal.latest_number if changes.log else 0
        self.journal.store(changes, self.service.book.next_number)
        if changes.log and self._listeners:
            for number, entry in self.journal.log_after(latest):
                for key, listener in list(self._listeners.items()):
                    try:
                        listener(number, entry)
                    except RuntimeError:  # the loop of the server has ended
                        del self._listeners[key]

    def _open(self) -> None:
        self.journal = Journal(self._path, self._limits)
        self.service = self._make(self.journal)
        self.problem = ""

    def _reopen(self) -> bool:
        if time.monotonic() < self._retry_at:
            return False
        try:
            self._open()
        except JournalError as error:
            self._retry_at, self.problem = time.monotonic() + RETRY_SECONDS, str(error)
            return False
        self._log(f"{self._path}: the journal can be written again; the service goes on")
        return True

    def _give_up(self, error: JournalError) -> None:
        self._log(f"the robot stops, and requests are refused: {error}")
        self.problem, self._retry_at = str(error), time.monotonic() + RETRY_SECONDS
        self.close()
        self.journal = self.service = None

    def _refuse(self, calls: List[Call]) -> None:
        for call in calls:
            if call.answer.set_running_or_notify_cancel():
                call.answer.set_exception(JournalError(self.problem))


def _give(future: "Future[Any]", answer: Callable[[], Any], problem: Optional[PlanarError]) -> None:
    """Answer a call, now that what it has changed is in the journal."""
    try:
        if problem is not None:
            raise problem
        future.set_result(answer())
    except PlanarError as error:
        future.set_exception(error)


def series_to_json(series: Series) -> Dict[str, Any]:
    """Return a series as JSON values."""
    return {**task_to_json(ServiceTask(series.id, series.request)), "status": "standby"}


# -- what is asked of the service ------------------------------------------------------------------------


def submit(document: Any) -> Act:
    """Accept a request; the answer is its task, with its planned end."""

    def act(host: ServiceHost, now: float) -> Callable[[], Any]:
        assert host.service is not None
        accepted = host.service.submit(document, now)
        return lambda: host.describe(accepted.id)

    return act


def cancel(task_id: str) -> Act:
    """Cancel a task or a series."""

    def act(host: ServiceHost, now: float) -> Callable[[], Any]:
        assert host.service is not None
        host.service.cancel(task_id, now)
        return lambda: {"success": True}

    return act


def task(task_id: str) -> Act:
    """Return a task or a series."""

    def act(host: ServiceHost, now: float) -> Callable[[], Any]:
        host.describe(task_id)  # an unknown one is an error of the call
        return lambda: host.describe(task_id)

    return act


def tasks() -> Act:
    """Return the open tasks in the order of the plan, and the series."""

    def answer(host: ServiceHost) -> Any:
        assert host.service is not None
        planned = sorted(host.service.book.tasks.values(), key=lambda each: each.estimate or float("inf"))
        return [
            *map(task_to_json, planned),
            *map(series_to_json, host.service.book.series.values()),
        ]

    return lambda host, now: lambda: answer(host)


def state() -> Act:
    """Return what the robot does."""

    def act(host: ServiceHost, now: float) -> Callable[[], Any]:
        assert host.service is not None
        service = host.service
        return lambda: service.state(now)

    return act


def history(limit: int) -> Act:
    """Return tasks that have ended, the latest first."""

    def act(host: ServiceHost, now: float) -> Callable[[], Any]:
        assert host.journal is not None
        journal = host.journal
        return lambda: [task_to_json(each) for each in journal.ended_tasks(limit=limit)]

    return act
