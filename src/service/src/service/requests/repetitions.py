"""Tasks of series: the next repetition of each is always in the queue."""

from dataclasses import replace
from datetime import datetime, tzinfo
from typing import Optional

from service.requests.calendar_times import DAY, clock_text, next_repetition
from service.requests.request import TaskRequest
from service.task import Series, ServiceTask, TaskStatus
from service.task_book import TaskBook

# Repetitions that were due longer ago than that are not looked at one by one [s].
CATCH_UP = DAY


class Repetitions:
    """Adds the tasks of series.

    Args:
        book: Tasks and series, updated in place.
        zone: Time zone; None for that of the machine.
    """

    def __init__(self, book: TaskBook, zone: Optional[tzinfo] = None):
        self._book, self._zone = book, zone

    def update(self, now: float) -> bool:
        """Add repetitions that are next; of those missed while the robot was off only the latest is done.

        Args:
            now: Unix time [s].

        Returns:
            Whether a task was added.
        """
        is_changed = False
        for series in list(self._book.series.values()):
            if series.next_start < now - CATCH_UP:
                self._book.log(now, "skipped", "repetitions of more than a day ago", series.id)
                series = self._advanced(series, now - CATCH_UP)
            while self._is_next_due(series, now):
                is_changed = True
                self._add(series, now)
                series = self._advanced(series, series.next_start)
        return self._skip_superseded(now) or is_changed

    def _skip_superseded(self, now: float) -> bool:
        """Skip repetitions that were not started when the next one is due, but for later deadlines."""
        waiting = [task for task in self._book.tasks.values() if task.series and task.started_at is None]
        latest = {task.series: task for task in waiting if task.request.release <= now}
        old = [
            task
            for task in waiting
            if task.request.release <= now
            and task is not latest[task.series]
            and (task.request.deadline or now) <= now
        ]
        for task in old:
            self._book.put(task.ended(TaskStatus.SKIPPED, now, "its next repetition is due"))
            self._book.log(now, "skipped", "the next repetition is due", task.id)
        return bool(old)

    def next_due(self) -> Optional[float]:
        """Return the Unix time of the next repetition that is not in the queue yet [s]; None for none."""
        return min((series.next_start for series in self._book.series.values()), default=None)

    def _is_next_due(self, series: Series, now: float) -> bool:
        if series.next_start <= now:
            return True
        waiting = (task for task in self._book.tasks.values() if task.series == series.id)
        return all(task.request.release <= now for task in waiting)

    def _advanced(self, series: Series, after: float) -> Series:
        following = next_repetition(series.request.repeat, after, self._zone)
        series = replace(series, next_start=following)
        self._book.put_series(series)
        return series

    def _add(self, series: Series, now: float) -> None:
        start = series.next_start
        stamp = datetime.fromtimestamp(start, self._zone).strftime("%Y%m%dT%H%M")
        task = ServiceTask(f"{series.id}@{stamp}", _repetition(series.request, start), series=series.id)
        if task.id in self._book.tasks:
            return
        following = next_repetition(series.request.repeat, start, self._zone)
        deadline = task.request.deadline
        if following <= now or (deadline is not None and deadline < now):
            task = task.ended(TaskStatus.SKIPPED, now, "due while the robot was off")
            self._book.log(now, "skipped", f"of {clock_text(start, self._zone)}", task.id)
        self._book.put(task)


def _repetition(request: TaskRequest, start: float) -> TaskRequest:
    """Return the request of one repetition; its deadline is as long after its start as that of the first."""
    deadline = request.deadline
    if deadline is not None:
        deadline = start + deadline - request.release
    return replace(request, repeat="", earliest_start=start, deadline=deadline)
