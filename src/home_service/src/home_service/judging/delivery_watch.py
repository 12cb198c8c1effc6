"""Follows the deliveries of a mission and measures where the robot truly stood at each arrival."""

from typing import Callable, Dict, List, Mapping, Optional

from home_service.judging.verdict import DeliveryRecord
from pick_objects import Delivery, Stage
from planar import Pose2
from planar.maps.places import NamedPlace

ENDS = (Stage.DELIVERED, Stage.FAILED, Stage.CANCELLED)


class DeliveryWatch:
    """Keeps a record of each delivery. ``records`` is changed in place; ``say`` is told of each arrival."""

    def __init__(
        self, places: Mapping[str, NamedPlace], records: List[DeliveryRecord], say: Callable[[str], None]
    ):
        self._places, self._records, self._say = places, records, say
        self._stages: Dict[str, Stage] = {}

    def see(
        self, delivery: Delivery, stage: Stage, attempts: int, reason: str, truth: Optional[Pose2]
    ) -> None:
        """A delivery has come to ``stage`` while the robot truly stood at ``truth``, if that is known."""
        record = next((known for known in reversed(self._records) if known.name == delivery.name), None)
        is_another = stage not in ENDS and self._stages.get(delivery.name) in ENDS
        if record is None or is_another:  # a robot that serves is sent one mission after the other
            self._stages.pop(delivery.name, None)
            record = DeliveryRecord(delivery.name, delivery.thing, delivery.source, delivery.destination)
            self._records.append(record)
        before = self._stages.get(delivery.name, Stage.WAITING).value
        self._stages[delivery.name] = stage
        record.state, record.attempts, record.reason = _words(stage), attempts, reason
        if before < Stage.PICKING_UP.value <= stage.value <= Stage.DELIVERED.value:
            record.pickup_error = self._error_at(delivery.source, truth)
        if before < Stage.SETTING_DOWN.value <= stage.value <= Stage.DELIVERED.value:
            record.dropoff_error = self._error_at(delivery.destination, truth)

    def _error_at(self, name: str, truth: Optional[Pose2]) -> Optional[float]:
        if truth is None or name not in self._places:
            return None
        error = self._places[name].distance_to(truth)
        self._say(f"at {name}: truly {error:.3f} m from it")
        return error


def _words(stage: Stage) -> str:
    return stage.name.lower().replace("_", " ")
