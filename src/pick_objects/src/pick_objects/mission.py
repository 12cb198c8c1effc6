"""What a mission is: objects, and deliveries of them between places."""

from dataclasses import dataclass, field, replace
from itertools import count
from typing import Mapping, Optional, Tuple

from pick_objects.config import ErrandSettings
from planar import PlanarError
from planar.maps.places import NamedPlace

ORANGE = (0.9, 0.4, 0.1)


class MissionError(PlanarError):
    """A mission, or a change of one, that cannot be carried out as it is put."""


@dataclass(frozen=True)
class MissionObject:
    """An object to be carried: the edge of a cube around it in metres; red, green and blue from 0 to 1.

    ``solid``: whether it is a body in the simulator, a column that wide.
    """

    name: str
    size: float = 0.2
    color: Tuple[float, float, float] = ORANGE
    solid: bool = False


@dataclass(frozen=True)
class Delivery:
    """``object_name`` is to be carried from one place to another; all are named.

    ``after``: deliveries that must have been made before. ``goal_timeout``: seconds, if not the mission's.
    """

    name: str
    object_name: str
    source: str
    destination: str
    after: Tuple[str, ...] = ()
    goal_timeout: Optional[float] = None


@dataclass(frozen=True)
class Mission:
    """Deliveries between places that it knows by name."""

    name: str
    places: Mapping[str, NamedPlace]
    deliveries: Tuple[Delivery, ...]
    objects: Mapping[str, MissionObject] = field(default_factory=dict)
    settings: ErrandSettings = ErrandSettings()

    def object_named(self, name: str) -> MissionObject:
        """The object of that name; one that nobody has described is an ordinary one."""
        return self.objects.get(name, MissionObject(name))

    def with_delivery(self, delivery: Delivery) -> "Mission":
        """The mission with one more delivery, named if it had no name. Raises MissionError."""
        names = {known.name for known in self.deliveries}
        name = delivery.name or next(
            name for number in count(len(names) + 1) if (name := f"delivery {number}") not in names
        )
        named = replace(delivery, name=name)
        if name in names:
            raise MissionError(f"there is a delivery {name} already")
        if not named.object_name:
            raise MissionError(f"{name}: no object is named")
        for place in (named.source, named.destination):
            if place not in self.places:
                raise MissionError(f"{name}: there is no place '{place}'; known are {', '.join(self.places)}")
        if named.source == named.destination:
            raise MissionError(f"{name}: {named.object_name} is at {named.source} already")
        return replace(self, deliveries=(*self.deliveries, named))


def errand_mission(
    pickup: NamedPlace, dropoff: NamedPlace, settings: ErrandSettings = ErrandSettings()
) -> Mission:
    """The mission of a single delivery: the object at the pick-up zone is wanted at the drop-off zone."""
    places = {pickup.name: pickup, dropoff.name: dropoff}
    delivery = Delivery("errand", "parcel", pickup.name, dropoff.name)
    return Mission("errand", places, (delivery,), settings=settings)
