"""Fill the record of a mission from run events."""

import contextlib
import math
import time
from collections import deque
from typing import Callable, Deque, Dict, Mapping, Optional, Tuple

from evaluation.delivery_monitor import DeliveryMonitor
from evaluation.event_stream import EventStream
from evaluation.events import BodiesTouched, MarkerUpdated, MissionRequested, MissionUpdated, TruthUpdated
from evaluation.marker_log import MarkerLog
from evaluation.verdict import FINAL_STATES, MissionRecord
from pick_objects import parse_mission
from planar import PlanarError, Pose2
from planar.maps.places import NamedPlace

# True poses that are kept to look up the pose at a stamp.
TRUTH_HISTORY = 500
# Simulated and wall-clock time after the end of a mission in which further events are waited for [s].
GRACE_SECONDS = 10.0


class MissionMonitor:
    """Fills a mission record. Arrivals are judged by the true pose at their stamp.

    Args:
        places: Places by name; places of a mission that is sent to the robot are added.
        log: Called with each line for people.
        clock: Returns the wall-clock time [s].

    Attributes:
        record: Observations of the mission.
    """

    def __init__(
        self,
        places: Mapping[str, NamedPlace],
        log: Callable[[str], None],
        clock: Callable[[], float] = time.monotonic,
    ):
        self.record = MissionRecord()
        self._places: Dict[str, NamedPlace] = dict(places)
        self._log, self._clock = log, clock
        self._now = 0.0
        self._recent: Deque[Tuple[float, Pose2]] = deque(maxlen=TRUTH_HISTORY)
        self._pending: Deque[MissionUpdated] = deque()
        self._deliveries = DeliveryMonitor(self._places, self.record.deliveries, log)
        self._markers = MarkerLog(self._places, self.record)
        # Simulated and wall-clock time of the end of the mission, once it has come.
        self._ended_at: Optional[Tuple[float, float]] = None

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(TruthUpdated, self._on_truth)
        events.subscribe(BodiesTouched, self._on_contact)
        events.subscribe(MissionRequested, self._on_request)
        events.subscribe(MissionUpdated, self._on_mission)
        events.subscribe(MarkerUpdated, self._markers.add)

    @property
    def is_past_grace_period(self) -> bool:
        """Whether the mission ended so long ago that nothing further is to be expected."""
        now = (self._now, self._clock())
        return self._ended_at is not None and all(
            t > end + GRACE_SECONDS for t, end in zip(now, self._ended_at)
        )

    def _on_truth(self, event: TruthUpdated) -> None:
        if event.stamp < self._now:
            # Time was set back: what was published before does not wait for that time again.
            self._process_pending(math.inf)
            self._recent.clear()
        self._now = event.stamp
        self._recent.append((event.stamp, event.pose))
        self._process_pending(event.stamp)

    def _on_contact(self, event: BodiesTouched) -> None:
        for name in event.names:
            self.record.collisions.append(name)
            self._log(f"collision with {name}")

    def _on_request(self, event: MissionRequested) -> None:
        """Add the places of a mission; the robot reports a mission that is not valid."""
        with contextlib.suppress(PlanarError):
            if event.text:
                self._places.update(parse_mission(event.text, self._places).places)

    def _on_mission(self, event: MissionUpdated) -> None:
        self._pending.append(event)
        self._process_pending(self._now)

    def _process_pending(self, until: float) -> None:
        """Process mission events with stamps up to ``until``: the truth at later ones is not known yet."""
        while self._pending and self._pending[0].stamp <= until:
            event = self._pending.popleft()
            truth = self._truth_at(event.stamp)
            for state in event.deliveries:
                self._deliveries.update(
                    state.delivery, state.stage, state.attempts, state.reason, truth, state.object_at
                )
            self.record.reason, self.record.final_state = event.reason, event.state
            self._markers.flush()
            if event.state not in FINAL_STATES:
                self._ended_at = None
            elif self._ended_at is None:
                self._ended_at = (self._now, self._clock())

    def _truth_at(self, stamp: float) -> Optional[Pose2]:
        if not self._recent:
            return None
        return min(self._recent, key=lambda entry: abs(entry[0] - stamp))[1]
