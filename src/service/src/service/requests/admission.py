"""Acceptance and cancellation of requests."""

import re
from typing import Any, Callable, List, Mapping, Optional, Sequence, Union

from planar.maps.places import NamedPlace
from service.errors import QueueFullError, RequestError, TaskEndedError, UnknownTaskError
from service.requests.parser import Knowledge, parse_request
from service.requests.repetitions import Repetitions
from service.requests.request import Deliver, Fetch, Find
from service.task import ObjectState, Series, ServiceTask, TaskStatus
from service.task_book import TaskBook

GIVEN_ID = re.compile(r"(?=.*[A-Za-z_-])[A-Za-z0-9_.:-]{1,64}")
# Returns a task that has ended, from the journal; None if there is none of that id.
FindEnded = Callable[[str], Optional[ServiceTask]]
Accepted = Union[ServiceTask, Series]


class Admission:
    """Accepts requests into the book.

    Args:
        book: Tasks, series and objects, updated in place.
        places: Places by name.
        known: What requests may refer to.
        repetitions: Adds tasks of series.
        max_open: Number of open tasks and series above which requests are refused.
        find_ended: Looks up tasks that have ended.
    """

    def __init__(
        self,
        book: TaskBook,
        places: Mapping[str, NamedPlace],
        known: Knowledge,
        repetitions: Repetitions,
        max_open: int,
        find_ended: FindEnded = lambda task_id: None,
    ):
        self._book, self._places, self._known = book, places, known
        self._repetitions, self._max_open, self._find_ended = repetitions, max_open, find_ended

    def submit(self, document: Any, now: float) -> Accepted:
        """Accept a request.

        A document with an ``id`` that was accepted before returns that task, so that a client may send it
        again if it got no answer.

        Args:
            document: See ``parse_request``.
            now: Unix time [s].

        Raises:
            RequestError: If it is invalid, or contradicts open requests.
            QueueFullError: If too many are open.
        """
        given = document.get("id", "") if isinstance(document, Mapping) else ""
        earlier = self._earlier(given) if given else None
        if earlier is not None:
            return earlier
        request = parse_request(document, self._known, now)
        if len(self._book.tasks) + len(self._book.series) >= self._max_open:
            raise QueueFullError(f"{self._max_open} requests are open already; send it again later")
        self._check_object(request.description)
        self._check_after(request.after)
        task_id = given or self._book.new_id()
        self._book.log(now, "accepted", f"from {request.requester or 'unknown'}", task_id)
        if request.repeat:
            series = Series(task_id, request, request.release)
            self._book.put_series(series)
            self._repetitions.update(now)
            return series
        if isinstance(request.description, Deliver):
            self._trust(request.description)
        return self._book.put(ServiceTask(task_id, request))

    def cancel_series(self, series_id: str) -> List[str]:
        """End a series; return the ids of its open tasks."""
        self._book.end_series(series_id)
        return [task.id for task in self._book.tasks.values() if task.series == series_id]

    def find(self, task_id: str) -> ServiceTask:
        """Return a task that is open or has ended.

        Raises:
            UnknownTaskError: If there is none.
        """
        task = self._book.tasks.get(task_id) or self._find_ended(task_id)
        if task is None:
            raise UnknownTaskError(f"there is no task {task_id[:64]}")
        return task

    def check_open(self, task_id: str) -> None:
        """Check that a task can be cancelled.

        Raises:
            UnknownTaskError: If there is none.
            TaskEndedError: If it has ended.
        """
        task = self.find(task_id)
        if not task.is_open:
            raise TaskEndedError(f"task {task_id} is {task.status.value} already")

    def _earlier(self, given: Any) -> Optional[Accepted]:
        if not isinstance(given, str) or not GIVEN_ID.fullmatch(given):
            raise RequestError(
                ["id: expected at most 64 letters, digits and any of _ . : -, not only digits"]
            )
        return self._book.tasks.get(given) or self._book.series.get(given) or self._find_ended(given)

    def _check_after(self, names: Sequence[str]) -> None:
        """Refuse to wait for tasks that are unknown, or were not done."""
        for name in names:
            earlier = self._book.tasks.get(name) or self._find_ended(name)
            if earlier is None:
                raise RequestError([f"after: there is no task {name}"])
            if not earlier.is_open and earlier.status is not TaskStatus.COMPLETED:
                raise RequestError([f"after: task {name} is {earlier.status.value}"])

    def _check_object(self, description: Any) -> None:
        """Refuse what contradicts the open requests."""
        name = getattr(description, "object_name", "")
        if not name:
            return
        left_at = self._book.object_after_queue(name)
        if isinstance(description, Deliver) and left_at not in (None, description.source):
            raise RequestError(
                [f"description: from: an open request takes {name} to {left_at}; expected from {left_at}"]
            )
        self._check_search(description, name, left_at)
        if isinstance(description, Fetch):
            state = self._book.objects.get(name)
            where = left_at or (state.place if state else None)
            if where == description.destination:
                raise RequestError([f"description: to: {name} is at {where} already"])

    def _check_search(self, description: Any, name: str, left_at: Optional[str]) -> None:
        """Refuse to search what cannot be searched; what is known to be somewhere is not searched."""
        state = self._book.objects.get(name)
        is_known = left_at is not None or (state is not None and state.is_located)
        if isinstance(description, (Fetch, Find)) and not is_known:
            problem = self._known.problem_with_search(name)
            if problem:
                raise RequestError([f"description: object: {problem}"])

    def _trust(self, description: Deliver) -> None:
        """Note where the object is according to the request, unless an open request moves it."""
        name = description.object_name
        if self._book.object_after_queue(name) is None:
            pose = self._places[description.source].pose
            self._book.put_object(name, ObjectState(description.source, pose))
