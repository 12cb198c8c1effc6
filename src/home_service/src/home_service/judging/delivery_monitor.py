"""Track the deliveries of a mission and measure the true position error at each arrival."""

from typing import Callable, Dict, List, Mapping, Optional

from home_service.judging.verdict import DeliveryRecord
from pick_objects import Delivery, DeliveryStage
from planar import Pose2
from planar.maps.places import NamedPlace

ENDS = (DeliveryStage.DELIVERED, DeliveryStage.FAILED, DeliveryStage.CANCELLED)


class DeliveryMonitor:
    """Keeps a record of each delivery.

    Args:
        places: Places by name; more may be added later.
        records: List of the records, extended and updated in place.
        log: Called with a line at each arrival.
    """

    def __init__(
        self, places: Mapping[str, NamedPlace], records: List[DeliveryRecord], log: Callable[[str], None]
    ):
        self._places, self._records, self._log = places, records, log
        self._stages: Dict[str, DeliveryStage] = {}

    def update(
        self, delivery: Delivery, stage: DeliveryStage, attempts: int, reason: str, truth: Optional[Pose2]
    ) -> None:
        """Update the record of a delivery.

        Args:
            delivery: The delivery.
            stage: Its current stage.
            attempts: Goals sent for it so far.
            reason: Why it failed.
            truth: True pose of the robot in the world at that time, if known.
        """
        record = next((known for known in reversed(self._records) if known.name == delivery.name), None)
        is_another = stage not in ENDS and self._stages.get(delivery.name) in ENDS
        if record is None or is_another:  # with --serve, missions of the same name may follow each other
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
