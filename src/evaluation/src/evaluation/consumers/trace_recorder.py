"""Records the trace of a run, and what may keep the run from being repeatable."""

from typing import Any, Callable, Mapping, Optional, Tuple, Type

from evaluation.event_stream import EventStream
from evaluation.events import (
    EstimateUpdated,
    ExplorationEnded,
    GoalAccepted,
    GoalEnded,
    MarkerUpdated,
    MissionUpdated,
    OtherRobotUpdated,
    Publication,
    RemarksUpdated,
    RunEvent,
    TruthUpdated,
)
from evaluation.result import ResultFile
from evaluation.trace import FILE, Trace, TraceEntry, hash_of, write_trace

# Events that end the trace, if they are of the judged robot.
OUTCOMES = (GoalEnded, MissionUpdated, ExplorationEnded)


class TraceRecorder:
    """Adds published events to a trace."""

    def __init__(self) -> None:
        self._trace = Trace()
        self._remarks: Tuple[str, ...] = ()
        self._now = 0

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        for kind in TEXTS:
            events.subscribe(kind, self._on_event)
        events.subscribe(OtherRobotUpdated, self._on_other_robot)
        events.subscribe(MarkerUpdated, self._on_marker)
        events.subscribe(RemarksUpdated, self._on_remarks)

    def is_settled(self) -> bool:
        """Whether everything published before the last outcome should have been received by now."""
        return self._trace.is_settled(self._now)

    def save(self, result: ResultFile) -> None:
        """Add hash and repeatability to a result and write the trace, if anything was driven."""
        with result.recording_gaps(FILE):
            content = self._trace.content()
            if content:
                result.add(hash=hash_of(content))
                result.add(repeatable=not self._remarks, not_repeatable_because=list(self._remarks))
                write_trace(result.folder, content)

    def _on_event(self, event: Any) -> None:
        entry = self._add(event)
        if entry is None:
            return
        if isinstance(event, OUTCOMES):
            self._trace.end(entry)
        elif isinstance(event, TruthUpdated):
            self._now = entry.stamp

    def _on_other_robot(self, other: OtherRobotUpdated) -> None:
        if type(other.event) in TEXTS:
            self._add(other.event)

    def _add(self, event: Any) -> Optional[TraceEntry]:
        """Add an event and return its entry; None if it was not published."""
        publication: Optional[Publication] = event.publication
        if publication is None:
            return None
        text = TEXTS[type(event)](event)
        entry = TraceEntry(publication.stamp, publication.topic, publication.node, text)
        self._trace.add(entry)
        if isinstance(event, GoalAccepted):
            self._trace.start(entry.stamp)
        return entry

    def _on_marker(self, event: MarkerUpdated) -> None:
        x, y, z = event.position
        self._trace.add_unstamped(f"marker {event.name} {event.number}: {event.action} at {x!r} {y!r} {z!r}")

    def _on_remarks(self, event: RemarksUpdated) -> None:
        self._remarks = event.lines


def _pose(event: Any) -> str:
    z, w = event.publication.rotation
    return f"{event.pose.x!r} {event.pose.y!r} {z!r} {w!r}"


def _status(event: Any) -> str:
    return f"{event.status} {event.text!r}"


def _mission(event: MissionUpdated) -> str:
    stages = ", ".join(f"{each.delivery.name}: {each.stage.value}" for each in event.deliveries)
    return f"{event.state!r} at {event.place!r}, attempt {event.attempt} ({stages})"


# Content of each kind of event in the trace.
TEXTS: Mapping[Type[RunEvent], Callable[[Any], str]] = {
    TruthUpdated: _pose,
    EstimateUpdated: _pose,
    GoalAccepted: _pose,
    GoalEnded: _status,
    ExplorationEnded: _status,
    MissionUpdated: _mission,
}
