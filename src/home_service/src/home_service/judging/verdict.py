"""Was the mission really done? Judged by ground truth, not by what the robot believes."""

from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Sequence, Set

ARRIVAL_TOLERANCE = 0.25
ERRAND, MARKERS, OBJECTS, DEMO = "errand", "markers", "objects", "demo"
EXPECTED_MARKERS = ["shown at pickup", "hidden", "shown at dropoff"]
FINAL_STATES = ("delivered", "failed", "cancelled")


@dataclass
class DeliveryRecord:
    """What was seen of a delivery. Errors: how far from a pose of the place the robot truly stood, metres."""

    name: str
    object: str
    source: str
    destination: str
    state: str = "waiting"
    attempts: int = 0
    reason: str = ""
    pickup_error: Optional[float] = None
    dropoff_error: Optional[float] = None

    def result_fields(self) -> Dict[str, Any]:
        """As it stands in result.json; metres."""
        return {
            "name": self.name,
            "object": self.object,
            "from": self.source,
            "to": self.destination,
            "state": self.state,
            "attempts": self.attempts,
            "reason": self.reason,
            "pickup_error": self.pickup_error and round(self.pickup_error, 4),
            "dropoff_error": self.dropoff_error and round(self.dropoff_error, 4),
        }

    @property
    def failure(self) -> Optional[str]:
        """Why this delivery is not proven; None if it is."""
        if self.state != "delivered":
            return f"{self.name} is {self.state}" + (f": {self.reason}" if self.reason else "")
        for place, error in ((self.source, self.pickup_error), (self.destination, self.dropoff_error)):
            if error is None:
                return f"the robot never said that it arrived at {place}"
            if error > ARRIVAL_TOLERANCE:
                return f"at {place} the robot truly stood {error:.2f} m off, more than {ARRIVAL_TOLERANCE} m"
        return None

    @property
    def expected_markers(self) -> List[str]:
        """What its object's marker must have shown, in this order."""
        places = (self.source, self.destination)
        return [f"{self.object} at {places[0]}", f"{self.object} carried", f"{self.object} at {places[1]}"]


@dataclass
class MissionRecord:
    """What was seen of a run. ``reason``: the robot's own words for how its mission ended."""

    deliveries: List[DeliveryRecord] = field(default_factory=list)
    collisions: List[str] = field(default_factory=list)
    markers: List[str] = field(default_factory=list)
    final_state: str = ""
    reason: str = ""
    failure: str = ""

    @property
    def position_errors(self) -> Dict[str, float]:
        """The error at each place that the robot came to."""
        errors = {}
        for record in self.deliveries:
            errors[record.source], errors[record.destination] = record.pickup_error, record.dropoff_error
        return {place: error for place, error in errors.items() if error is not None}

    def result_fields(self) -> Dict[str, Any]:
        """What belongs into result.json; metres."""
        return {
            "position_error": {place: round(error, 4) for place, error in self.position_errors.items()},
            "deliveries": [record.result_fields() for record in self.deliveries],
            "collisions": self.collisions,
            "markers": self.markers,
            "final_state": self.final_state,
        }

    def is_complete(self, expected: Set[str]) -> bool:
        """Whether everything expected has been seen, or can no longer come."""
        if self.failure or self.final_state in ("failed", "cancelled"):
            return True
        if ERRAND in expected and self.final_state not in FINAL_STATES:
            return False
        if OBJECTS in expected and self.objects_without_markers:
            return False
        return not expected & {MARKERS, DEMO} or self.markers[-1:] == EXPECTED_MARKERS[-1:]

    @property
    def objects_without_markers(self) -> List[str]:
        """The delivered objects whose markers have not told the whole story."""
        untold = []
        for record in self.deliveries:
            told = iter(self.markers)
            if record.state == "delivered" and not all(event in told for event in record.expected_markers):
                untold.append(record.object)
        return untold


@dataclass(frozen=True)
class Verdict:
    """Whether a run succeeded, and why."""

    success: bool
    reason: str


def judge(record: MissionRecord, expected: Set[str]) -> Verdict:
    """Success only if all that was expected was truly seen and nothing was hit."""
    failure = record.failure or None
    if failure is None and ERRAND in expected:
        failure = _errand_failure(record)
    if failure is None and OBJECTS in expected and record.objects_without_markers:
        failure = f"the markers of {', '.join(record.objects_without_markers)} did not go with the objects"
    if failure is None and expected & {MARKERS, DEMO} and record.markers != EXPECTED_MARKERS:
        failure = (
            f"the marker was {', '.join(record.markers) or 'never shown'}, not {', '.join(EXPECTED_MARKERS)}"
        )
    failure = failure or collision(record.collisions)
    return Verdict(failure is None, failure or _success_reason(record, expected))


def collision(touched: Sequence[str]) -> Optional[str]:
    """What was collided with, in words; None if nothing was touched."""
    return f"collided with {', '.join(sorted(set(touched)))}" if touched else None


def _errand_failure(record: MissionRecord) -> Optional[str]:
    if record.final_state != "delivered":
        return record.reason or f"the mission ended in the state '{record.final_state or 'not started'}'"
    failures = [delivery.failure for delivery in record.deliveries if delivery.state != "cancelled"]
    return next((text for text in failures if text), None if failures else "nothing was delivered")


def _success_reason(record: MissionRecord, expected: Set[str]) -> str:
    if ERRAND not in expected:
        return f"the marker was {', '.join(record.markers)}"
    worst = max(record.position_errors.values())
    what = record.reason if len(record.deliveries) > 1 else "picked up and delivered"
    return f"{what}, at most {worst:.2f} m off, no collision"
