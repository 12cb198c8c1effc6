"""Verdict of a mission, by ground truth and not by the robot's estimate."""

from dataclasses import dataclass, field
from typing import Any, Dict, Iterable, List, Optional, Sequence, Set

from planar.maps.places import NamedPlace
from planar.maps.semantic_map import PlacedObject

ARRIVAL_TOLERANCE = 0.25
ERRAND, MARKERS, OBJECTS, DEMO = "errand", "markers", "objects", "demo"
EXPECTED_MARKERS = ["shown at pickup", "hidden", "shown at dropoff"]
# Name of the place, among those of a run, where an object that is searched truly is.
TRUE_PLACE = "true place of {}"
FINAL_STATES = ("delivered", "failed", "cancelled")


def true_places(objects: Iterable[PlacedObject]) -> Dict[str, NamedPlace]:
    """Return the places by which searches are judged, by name.

    Args:
        objects: Where objects truly are.
    """
    names = {item.name: TRUE_PLACE.format(item.name) for item in objects}
    return {names[item.name]: NamedPlace(names[item.name], item.pose) for item in objects}


@dataclass
class DeliveryRecord:
    """Observations of a delivery.

    Attributes:
        name: Name of the delivery.
        object: Object to carry.
        source: Place where it is picked up; empty: it is searched.
        destination: Place where it is set down; empty: it is only to be found.
        state: Last published state.
        attempts: Goals sent for it.
        retries: Goals beyond one to each of its places.
        reason: Why it failed.
        pickup_error: True distance from the nearest pose of the source at the pick-up, before it on
            arrival; of an object that was searched that beyond the robot's reach, of one that was only to be
            found that of where it was reported [m].
        dropoff_error: The same at the destination and the set-down [m].
    """

    name: str
    object: str
    source: str
    destination: str
    state: str = "waiting"
    attempts: int = 0
    retries: int = 0
    reason: str = ""
    pickup_error: Optional[float] = None
    dropoff_error: Optional[float] = None

    def result_fields(self) -> Dict[str, Any]:
        """Return the record as written to result.json."""
        return {
            "name": self.name,
            "object": self.object,
            "from": self.source,
            "to": self.destination,
            "state": self.state,
            "attempts": self.attempts,
            "retries": self.retries,
            "reason": self.reason,
            "pickup_error": self.pickup_error and round(self.pickup_error, 4),
            "dropoff_error": self.dropoff_error and round(self.dropoff_error, 4),
        }

    @property
    def failure(self) -> Optional[str]:
        """Why the delivery is not proven; None if it is."""
        if self.state != "delivered":
            return f"{self.name} is {self.state}" + (f": {self.reason}" if self.reason else "")
        if not self.destination:
            return self._finding_failure
        source = self.source or TRUE_PLACE.format(self.object)
        for place, error in ((source, self.pickup_error), (self.destination, self.dropoff_error)):
            if error is None:
                return f"the robot never reported its arrival at {place}"
            if error > ARRIVAL_TOLERANCE:
                return f"at {place} the robot truly stood {error:.2f} m off, more than {ARRIVAL_TOLERANCE} m"
        return None

    @property
    def _finding_failure(self) -> Optional[str]:
        if self.pickup_error is None:
            return f"it is not known where {self.object} truly is"
        if self.pickup_error > ARRIVAL_TOLERANCE:
            return f"{self.object} truly is {self.pickup_error:.2f} m from where it was reported"
        return None

    @property
    def expected_markers(self) -> List[str]:
        """Changes that the object's marker must have shown, in order."""
        if not self.destination:
            return []
        source = [f"{self.object} at {self.source}"] if self.source else []
        return [*source, f"{self.object} carried", f"{self.object} at {self.destination}"]


@dataclass
class MissionRecord:
    """Observations of a run.

    Attributes:
        deliveries: Records of all deliveries.
        collisions: Names of what the robot touched.
        markers: Changes of the markers, in words.
        final_state: Last state of the mission.
        reason: How the mission ended, as published by the robot.
        failure: Why the run was cut short.
    """

    deliveries: List[DeliveryRecord] = field(default_factory=list)
    collisions: List[str] = field(default_factory=list)
    markers: List[str] = field(default_factory=list)
    final_state: str = ""
    reason: str = ""
    failure: str = ""

    @property
    def position_errors(self) -> Dict[str, float]:
        """Position error at each place that the robot arrived at [m]."""
        errors = {}
        for record in self.deliveries:
            errors[record.source or record.object] = record.pickup_error
            errors[record.destination] = record.dropoff_error
        return {place: error for place, error in errors.items() if error is not None}

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json."""
        return {
            "position_error": {place: round(error, 4) for place, error in self.position_errors.items()},
            "deliveries": [record.result_fields() for record in self.deliveries],
            "collisions": self.collisions,
            "markers": self.markers,
            "final_state": self.final_state,
        }

    def is_complete(self, expected: Set[str]) -> bool:
        """Whether everything expected has been observed, or can no longer occur."""
        if self.failure or self.final_state in ("failed", "cancelled"):
            return True
        if ERRAND in expected and self.final_state not in FINAL_STATES:
            return False
        if OBJECTS in expected and self.objects_without_markers:
            return False
        return not expected & {MARKERS, DEMO} or self.markers[-1:] == EXPECTED_MARKERS[-1:]

    @property
    def objects_without_markers(self) -> List[str]:
        """Delivered objects whose markers have not shown all expected changes."""
        incomplete = []
        for record in self.deliveries:
            shown = iter(self.markers)
            if record.state == "delivered" and not all(event in shown for event in record.expected_markers):
                incomplete.append(record.object)
        return incomplete


@dataclass(frozen=True)
class Verdict:
    """Whether a run succeeded, and why."""

    success: bool
    reason: str


def judge(record: MissionRecord, expected: Set[str]) -> Verdict:
    """Judge a run.

    Args:
        record: Observations of the run.
        expected: What must have been observed: ERRAND, MARKERS, OBJECTS, DEMO.

    Returns:
        Success only if everything expected was observed and nothing was touched.
    """
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
    """Return what the robot collided with, in words; None if nothing."""
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
    is_delivery = len(record.deliveries) == 1 and record.deliveries[0].destination
    what = "picked up and delivered" if is_delivery else record.reason
    return f"{what}, at most {worst:.2f} m off, no collision"
