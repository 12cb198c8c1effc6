"""Changes of the objects' markers, in words."""

from dataclasses import dataclass
from typing import Iterable, List, Mapping

from evaluation.verdict import MissionRecord
from planar import Pose2
from planar.maps.places import NamedPlace

# Name of the errand's marker; a mission's markers are named after their objects.
PARCEL = "parcel"


@dataclass(frozen=True)
class MarkerState:
    """A received marker.

    Attributes:
        name: Object that it shows.
        pose: Pose in the map.
        is_carried: It is shown on the robot.
        is_hidden: It was deleted.
    """

    name: str
    pose: Pose2
    is_carried: bool = False
    is_hidden: bool = False


class MarkerLog:
    """Fills ``markers`` of a mission record, one entry a change.

    Args:
        places: Places by name; more may be added later.
        mission_record: Record to fill.
    """

    def __init__(self, places: Mapping[str, NamedPlace], mission_record: MissionRecord):
        self._places, self._mission_record = places, mission_record
        self._pending: List[MarkerState] = []

    def add(self, marker: MarkerState) -> None:
        """Add a received marker."""
        self._pending.append(marker)
        self.flush()

    def flush(self) -> None:
        """Process markers of objects whose deliveries are known; the others wait."""
        known = {PARCEL, *(record.object for record in self._mission_record.deliveries)}
        markers, self._pending = self._pending, []
        for marker in markers:
            if marker.name not in known:
                self._pending.append(marker)
            elif self._places and (marker.name == PARCEL or not marker.is_hidden):
                self._append(self._event(marker))

    def _event(self, marker: MarkerState) -> str:
        if marker.name == PARCEL:
            return "hidden" if marker.is_hidden else f"shown at {self._nearest(marker.pose, self._places)}"
        if marker.is_carried:
            return f"{marker.name} carried"
        records = [record for record in self._mission_record.deliveries if record.object == marker.name]
        ends = [name for record in records for name in (record.source, record.destination)]
        names = [name for name in ends if name in self._places]
        return f"{marker.name} at {self._nearest(marker.pose, names or self._places)}"

    def _append(self, event: str) -> None:
        if self._mission_record.markers[-1:] != [event]:
            self._mission_record.markers.append(event)

    def _nearest(self, pose: Pose2, names: Iterable[str]) -> str:
        return min(names, key=lambda name: self._places[name].distance_to(pose))
