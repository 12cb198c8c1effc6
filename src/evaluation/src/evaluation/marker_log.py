"""Changes of the objects' markers, in words."""

from typing import Iterable, List, Mapping

from evaluation.events import DELETE, MarkerUpdated
from evaluation.verdict import TRUE_PLACE, MissionRecord
from planar import Pose2
from planar.maps.places import NamedPlace

# Name of the errand's marker; a mission's markers are named after their objects.
PARCEL = "parcel"


class MarkerLog:
    """Fills ``markers`` of a mission record, one entry a change.

    Args:
        places: Places by name; more may be added later.
        mission_record: Record to fill.
    """

    def __init__(self, places: Mapping[str, NamedPlace], mission_record: MissionRecord):
        self._places, self._mission_record = places, mission_record
        self._pending: List[MarkerUpdated] = []

    def add(self, marker: MarkerUpdated) -> None:
        """Add a marker; one whose position is out of range is ignored."""
        if _place_of(marker).is_in_range():
            self._pending.append(marker)
            self.flush()

    def flush(self) -> None:
        """Process markers of objects whose deliveries are known; the others wait."""
        known = {PARCEL, *(record.object for record in self._mission_record.deliveries)}
        markers, self._pending = self._pending, []
        for marker in markers:
            if marker.name not in known:
                self._pending.append(marker)
            elif self._places and (marker.name == PARCEL or marker.action != DELETE):
                self._append(self._event(marker))

    def _event(self, marker: MarkerUpdated) -> str:
        if marker.name == PARCEL:
            return (
                "hidden"
                if marker.action == DELETE
                else f"shown at {self._nearest(_place_of(marker), self._places)}"
            )
        if marker.is_carried:
            return f"{marker.name} carried"
        records = [record for record in self._mission_record.deliveries if record.object == marker.name]
        ends = [
            name
            for record in records
            for name in (record.source or TRUE_PLACE.format(record.object), record.destination)
        ]
        names = [name for name in ends if name in self._places]
        return f"{marker.name} at {self._nearest(_place_of(marker), names or self._places)}"

    def _append(self, event: str) -> None:
        if self._mission_record.markers[-1:] != [event]:
            self._mission_record.markers.append(event)

    def _nearest(self, pose: Pose2, names: Iterable[str]) -> str:
        return min(names, key=lambda name: self._places[name].distance_to(pose))


def _place_of(marker: MarkerUpdated) -> Pose2:
    return Pose2(*marker.position[:2])
