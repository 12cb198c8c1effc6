"""Figures of result.json that are computed from run events."""

import time
from typing import Any, Callable, Dict, Optional, Tuple

from evaluation.contracts import Figure
from evaluation.event_stream import EventStream
from evaluation.events import TruthUpdated
from planar import Pose2
from supervision.processes import start_of_this_process

# Distance from the start at which the robot has moved [m].
MOTION_DISTANCE = 0.02


class FirstMotion:
    """Measures the wall-clock time from the start of this process to the first motion of the robot."""

    def __init__(self) -> None:
        self._start: Optional[Pose2] = None
        self._wall: Optional[float] = None

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(TruthUpdated, self._on_truth)

    def result_fields(self) -> Dict[str, Any]:
        """Return the field of result.json."""
        seconds = None if self._wall is None else round(self._wall - start_of_this_process(), 3)
        return {"first_motion_wall_seconds": seconds}

    def _on_truth(self, event: TruthUpdated) -> None:
        self._start = self._start or event.pose
        if self._wall is None and self._start.distance_to(event.pose) > MOTION_DISTANCE:
            self._wall = time.time()


# Each is created for every run; its fields are described in config/result.schema.json.
FIGURES: Tuple[Callable[[], Figure], ...] = (FirstMotion,)
