"""Follows the deliveries of a mission and measures where the robot truly stood at each arrival."""

from typing import Callable, Dict, List, Mapping, Optional

from home_service.judging.verdict import DeliveryRecord
from pick_objects import Delivery, DeliveryStage
from planar import Pose2
from planar.maps.places import NamedPlace

ENDS = (DeliveryStage.DELIVERED, DeliveryStage.FAILED, DeliveryStage.CANCELLED)


class DeliveryMonitor:
    """Keeps a record of each delivery. ``records`` is changed in place; ``log`` is told of each arrival."""

    def __init__(
        self, places: Mapping[str, NamedPlace], records: List[DeliveryRecord], log: Callable[[str], None]
    ):
        self._places, self._records, self._log = places, records, log
        self._stages: Dict[str, DeliveryStage] = {}

    def update(
        self, delivery: Delivery, stage: DeliveryStage, attempts: int, reason: str, truth: Optional[Pose2]
    ) -> None:
        """A delivery has come to ``stage`` while the robot truly stood at ``truth``, if that is known."""
        record = next((known for known in reversed(self._records) if known.name == delivery.name), None)
        is_another = stage not in ENDS and self._stages.get(delivery.name) in ENDS
        if record is None or is_another:  # a robot that serves is sent one mission after the other
            self._stages.pop(delivery.name, None)
            record = DeliveryRecord(
                delivery.name, delivery.object_name, delivery.source, delivery.destination
            )
            self._records.append(record)
        before = self._stages.get(delivery.name, DeliveryStage.WAITING).value
        self._stages[delivery.name] = stage
        record.state, record.attempts, record.reason = _stage_name(stage), attempts, reason
        if before < DeliveryStage.PICKING_UP.value <= stage.value <= DeliveryStage.DELIVERED.value:
            record.pickup_error = self._error_at(delivery.source, truth)
        if before < DeliveryStage.SETTING_DOWN.value <= stage.value <= DeliveryStage.DELIVERED.value:
            record.dropoff_error = self._error_at(delivery.destination, truth)

    def _error_at(self, name: str, truth: Optional[Pose2]) -> Optional[float]:
        if truth is None or name not in self._places:
            return None
        error = self._places[name].distance_to(truth)
        self._log(f"at {name}: truly {error:.3f} m from it")
        return error


def _stage_name(stage: DeliveryStage) -> str:
    return stage.name.lower().replace("_", " ")
