"""Track the deliveries of a mission and measure the true position error at each pick-up and set-down."""

from typing import Callable, Dict, List, Mapping, NamedTuple, Optional, Tuple

from evaluation.verdict import ARRIVAL_TOLERANCE, TRUE_PLACE, DeliveryRecord
from pick_objects import Delivery, DeliveryStage
from pick_objects.mission import REACH
from planar import Pose2
from planar.maps.places import NamedPlace

ENDS = (DeliveryStage.DELIVERED, DeliveryStage.FAILED, DeliveryStage.CANCELLED)


class _Action(NamedTuple):
    """Picking up or setting down: the stage in which it is done, the stage after it, and what to log."""

    during: DeliveryStage
    done: DeliveryStage
    text: str


PICK_UP = _Action(DeliveryStage.PICKING_UP, DeliveryStage.CARRYING, "picked up")
SET_DOWN = _Action(DeliveryStage.SETTING_DOWN, DeliveryStage.DELIVERED, "set down")


class DeliveryMonitor:
    """Keeps a record of each delivery.

    Args:
        places: Places by name, among them the true ones of objects (TRUE_PLACE); more may be added later.
        records: List of the records, extended and updated in place.
        log: Called with a line at each arrival, and at a pick-up or set-down that is too far from its place.
    """

    def __init__(
        self, places: Mapping[str, NamedPlace], records: List[DeliveryRecord], log: Callable[[str], None]
    ):
        self._places, self._records, self._log = places, records, log
        self._stages: Dict[str, DeliveryStage] = {}

    def update(
        self,
        delivery: Delivery,
        stage: DeliveryStage,
        attempts: int,
        reason: str,
        truth: Optional[Pose2],
        object_at: Optional[Tuple[float, float]] = None,
    ) -> None:
        """Update the record of a delivery.

        Args:
            delivery: The delivery.
            stage: Its current stage.
            attempts: Goals sent for it so far.
            reason: Why it failed.
            truth: True pose of the robot in the world at that time, if known.
            object_at: Where the robot reports the object to be [m], if it knows.
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
        if stage.value <= DeliveryStage.DELIVERED.value:
            if not delivery.destination:
                record.pickup_error = self._error_of_finding(delivery.object_name, object_at)
                return
            record.retries = max(attempts - _drives(stage), 0) if delivery.source else 0
            stages = before, stage.value
            record.pickup_error = self._error(PICK_UP, delivery, record.pickup_error, stages, truth)
            record.dropoff_error = self._error(SET_DOWN, delivery, record.dropoff_error, stages, truth)

    def _error_of_finding(self, name: str, object_at: Optional[Tuple[float, float]]) -> Optional[float]:
        """Return the distance from where an object is reported to where it truly is [m]."""
        place = self._places.get(self._true_place(name))
        if place is None or object_at is None:
            return None
        return place.distance_to(Pose2(*object_at))

    def _true_place(self, name: str) -> str:
        """Return the name of the place where an object truly is: where it was set down last, if it was."""
        moves = (each for each in reversed(self._records) if each.object == name and each.destination)
        delivered = (each.destination for each in moves if each.state == _stage_name(SET_DOWN.done))
        return next(delivered, TRUE_PLACE.format(name))

    def _error(
        self,
        action: _Action,
        delivery: Delivery,
        known: Optional[float],
        stages: Tuple[int, int],
        truth: Optional[Pose2],
    ) -> Optional[float]:
        """Return the position error of an action: that on arrival until it is done, then that at its moment.

        Args:
            action: Picking up or setting down.
            delivery: The delivery.
            known: Error so far.
            stages: Stage before and now.
            truth: True pose of the robot now, if known.
        """
        before, stage = stages
        has_arrived = before < action.during.value <= stage
        if not has_arrived and not before < action.done.value <= stage:
            return known
        is_found = action is PICK_UP and not delivery.source
        name = delivery.source if action is PICK_UP else delivery.destination
        name = self._true_place(delivery.object_name) if is_found else name
        if truth is None or name not in self._places:
            return None
        error = max(self._places[name].distance_to(truth) - (REACH if is_found else 0.0), 0.0)
        if has_arrived:
            self._log(f"at {name}: truly {error:.3f} m from it")
        elif error > ARRIVAL_TOLERANCE:
            self._log(f"{action.text} at {name}: truly {error:.3f} m from it")
        return error


def _drives(stage: DeliveryStage) -> int:
    """Number of places to which a delivery has sent the robot, each with one goal if nothing goes wrong."""
    if stage is DeliveryStage.WAITING:
        return 0
    return 1 if stage.value < DeliveryStage.CARRYING.value else 2


def _stage_name(stage: DeliveryStage) -> str:
    return stage.name.lower().replace("_", " ")
