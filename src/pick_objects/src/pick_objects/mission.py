"""Missions: objects, and deliveries of them between places."""

from dataclasses import dataclass, field, replace
from itertools import count, takewhile
from typing import Mapping, Optional, Tuple

from pick_objects.config import ErrandSettings
from planar import PlanarError
from planar.maps.places import NamedPlace
from planar.maps.semantic_map import SemanticMap

ORANGE = (0.9, 0.4, 0.1)
# Farthest from an object that the robot can pick it up [m].
REACH = 1.5


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
    """An object to be carried from one place to another, or to be found; all are referred to by name.

    Attributes:
        name: Unique name in the mission.
        object_name: Object to carry or to find.
        source: Place where the object is; empty: where it is known to be, else it is searched.
        destination: Place where it is to be set down; empty: it is only to be found.
        after: Deliveries that must be completed before.
        goal_timeout: Time-out of a goal [s]; None: that of the mission.
    """

    name: str
    object_name: str
    source: str
    destination: str
    after: Tuple[str, ...] = ()
    goal_timeout: Optional[float] = None

    def __str__(self) -> str:
        if not self.destination:
            return f"find {self.object_name}"
        source = f" from {self.source}" if self.source else ""
        return f"{self.object_name}{source} to {self.destination}"


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

    def is_searched(self, delivery: Delivery) -> bool:
        """Whether the object of a delivery has to be searched: nothing states where it is."""
        earlier = takewhile(lambda each: each.name != delivery.name, self.deliveries)
        return not delivery.source and not any(each.object_name == delivery.object_name for each in earlier)

    def check_searches(self, semantic_map: Optional[SemanticMap]) -> None:
        """Check that all objects that have to be searched can be.

        Args:
            semantic_map: What is usually where; None: unknown.

        Raises:
            MissionError: If one cannot.
        """
        for delivery in self.deliveries:
            if not delivery.source and self.settings.order == "shortest":
                raise MissionError(f"{delivery}: the order shortest needs from; expected order: given")
            if not self.is_searched(delivery):
                continue
            if semantic_map is None:
                raise MissionError(
                    f"{delivery}: it has to be searched, and there is no semantic map; add from: PLACE, or "
                    "take a home of build_home.sh (--home FOLDER)"
                )
            problem = semantic_map.problem_with(delivery.object_name)
            if problem:
                raise MissionError(f"{delivery}: {problem}")

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
        if named.source and not named.destination:
            raise MissionError(f"{name}: an object that is only to be found has no place where it is")
        for place in filter(None, (named.source, named.destination)):
            if place not in self.places:
                raise MissionError(f"{name}: there is no place '{place}'; known are {', '.join(self.places)}")
        if named.source and named.source == named.destination:
            raise MissionError(f"{name}: {named.object_name} is at {named.source} already")
        return replace(self, deliveries=(*self.deliveries, named))


def errand_mission(
    pickup: NamedPlace, dropoff: NamedPlace, settings: ErrandSettings = ErrandSettings()
) -> Mission:
    """Return the mission with a single delivery, from the pick-up zone to the drop-off zone."""
    places = {pickup.name: pickup, dropoff.name: dropoff}
    delivery = Delivery("errand", "parcel", pickup.name, dropoff.name)
    return Mission("errand", places, (delivery,), settings=settings)
