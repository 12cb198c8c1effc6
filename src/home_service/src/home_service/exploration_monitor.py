"""Progress and end of an exploration."""

from typing import Optional

from evaluation.consumers.referee import Referee
from evaluation.event_stream import EventStream
from evaluation.events import ExplorationEnded, ExplorationUpdated


class ExplorationMonitor:
    """Shows the progress of an exploration as the referee's state.

    Args:
        referee: Referee of the run.

    Attributes:
        end: How the exploration has ended; None until then.
    """

    def __init__(self, referee: Referee):
        self.end: Optional[ExplorationEnded] = None
        self._referee = referee

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(ExplorationUpdated, self._on_progress)
        events.subscribe(ExplorationEnded, self._on_end)

    @property
    def simulated_seconds(self) -> float:
        """Simulated time of the run [s]."""
        return self._referee.simulated_seconds

    def _on_progress(self, event: ExplorationUpdated) -> None:
        self._referee.state = f"{event.state}, {event.area:.0f} m2 known, {event.frontiers} frontiers"

    def _on_end(self, event: ExplorationEnded) -> None:
        self.end = self.end or event
