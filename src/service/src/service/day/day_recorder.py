"""Record of a day of service from the events of a run over ROS, and from the service's journal."""

from pathlib import Path
from typing import Optional, Sequence

from evaluation.event_stream import EventStream
from evaluation.events import ServiceUpdated, StateUpdated, TruthUpdated
from service.day.simulated_day import SimulatedDayRecord
from service.journal import Journal
from service.requests.timed_requests import TimedRequest

# A gap between true poses from which on it is time that was skipped [s].
SKIPPED_SECONDS = 2.0


class DayRecorder:
    """Records what ``SimulatedDay`` does in one process.

    Args:
        origin: Unix time at the simulation's time 0 [s].
        until: Unix time at which the day ends; what comes later is left out [s].
    """

    def __init__(self, origin: float, until: float):
        self._origin, self._until = origin, until
        self._record = SimulatedDayRecord(end=origin)
        self._charge: Optional[float] = None

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(TruthUpdated, self._on_truth)
        events.subscribe(StateUpdated, self._on_state)
        events.subscribe(ServiceUpdated, self._on_service)

    def record(
        self, journal: Path, requests: Sequence[TimedRequest], collisions: Sequence[str]
    ) -> SimulatedDayRecord:
        """Return the record, with what the journal of the service holds.

        Args:
            journal: File of the journal.
            requests: Requests of the day, with their ids.
            collisions: Names of what the robot collided with by its own fault.

        Raises:
            JournalError: The journal cannot be read.
        """
        reader, record = Journal(journal, is_reader=True), self._record
        ended = reader.ended_tasks(limit=len(requests))[::-1]
        record.ended = [task for task in ended if (task.finished_at or 0.0) <= self._until]
        known = {task.id for task in (*ended, *reader.restore().tasks)}
        record.log = [entry for _, entry in reader.log_after(0, limit=100 * len(requests))]
        reader.close()
        sent = (str(each.document["id"]) for each in requests if each.stamp <= record.end)
        record.refused = [f"{name} was refused; the log states why" for name in sent if name not in known]
        record.contacts = sorted(set(collisions))
        return record

    def _on_truth(self, event: TruthUpdated) -> None:
        now, record = self._origin + event.stamp, self._record
        if now > self._until:
            return
        if now - record.end > SKIPPED_SECONDS:
            record.idle_seconds += now - record.end
        record.end = now
        record.note_pose(now, event.pose, self._charge)

    def _on_state(self, event: StateUpdated) -> None:
        now = self._origin + event.stamp
        if now <= self._until:
            self._record.note_activity(now, event.text)

    def _on_service(self, event: ServiceUpdated) -> None:
        self._charge, record = event.charge, self._record
        if event.charge is None:
            return
        record.lowest_charge = min(record.lowest_charge, event.charge)
        if event.charge <= 0.0 and record.empty_at is None:
            record.empty_at = self._origin + event.stamp
