"""Missions: objects, and deliveries of them between places."""

from dataclasses import dataclass, field, replace
from itertools import count
from typing import Mapping, Optional, Tuple

from pick_objects.config import ErrandSettings
from planar import PlanarError
from planar.maps.places import NamedPlace

ORANGE = (0.9, 0.4, 0.1)


class MissionError(PlanarError):
    """A mission, or a change to one, is not valid."""


@dataclass(frozen=True)
class MissionObject:
    """An object to be carried.

    Attributes:
        name: Unique name.
        size: Edge of a cube around it [m].
        color: Red, green and blue, 0 to 1.
        solid: It is a body in the simulator (a column of that width), not only a marker.
    """

    name: str
    size: float = 0.2
    color: Tuple[float, float, float] = ORANGE
    solid: bool = False


@dataclass(frozen=True)
class Delivery:
    """An object to be carried from one place to another; all are referred to by name.

    Attributes:
        name: Unique name in the mission.
        object_name: Object to carry.
        source: Place where the object is.
        destination: Place where it is to be set down.
        after: Deliveries that must be completed before.
        goal_timeout: Time-out of a goal [s]; None: that of the mission.
    """

    name: str
    object_name: str
    source: str
    destination: str
    after: Tuple[str, ...] = ()
    goal_timeout: Optional[float] = None


@dataclass(frozen=True)
class Mission:
    """Deliveries between named places.

    Attributes:
        name: Name of the mission.
        places: Places by name.
        deliveries: Deliveries in the given order.
        objects: Described objects by name.
        settings: Durations and patience.
    """

    name: str
    places: Mapping[str, NamedPlace]
    deliveries: Tuple[Delivery, ...]
    objects: Mapping[str, MissionObject] = field(default_factory=dict)
    settings: ErrandSettings = ErrandSettings()

    def object_named(self, name: str) -> MissionObject:
        """Return the object of that name, with default properties if it is not described."""
        return self.objects.get(name, MissionObject(name))

    def with_delivery(self, delivery: Delivery) -> "Mission":
        """Return the mission with one more delivery, which is given a name if it has none.

        Raises:
            MissionError: If the delivery is not valid.
        """
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
    """Return the mission with a single delivery, from the pick-up zone to the drop-off zone."""
    places = {pickup.name: pickup, dropoff.name: dropoff}
    delivery = Delivery("errand", "parcel", pickup.name, dropoff.name)
    return Mission("errand", places, (delivery,), settings=settings)
