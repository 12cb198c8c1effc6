"""Maps of the static layers, by the topic they come from."""

from dataclasses import dataclass
from typing import Mapping, NamedTuple, Optional, Union

from planar import OccupancyGrid


@dataclass(frozen=True, eq=False)
class StaticMap:
    """A map and the frame it lies in.

    Attributes:
        grid: The map.
        frame: Frame of its coordinates; empty: the frame of the global costmap.
    """

    grid: OccupancyGrid
    frame: str = ""


class StaticMapSource(NamedTuple):
    """Where a static layer has its map from; layers with equal sources share a map.

    Attributes:
        topic: Topic of the map.
        first_map_only: Whether later maps are ignored.
        with_updates: Whether changes on the topic with the suffix ``_updates`` are applied.
    """

    topic: str
    first_map_only: bool = False
    with_updates: bool = False


class StaticMaps:
    """Immutable maps by source.

    Args:
        by_source: Maps by the source of the layers.
        default: Map of every other source, as without ROS, where there is one map.
    """

    def __init__(
        self, by_source: Mapping[StaticMapSource, StaticMap] = {}, default: Optional[StaticMap] = None
    ):
        self._by_source, self._default = dict(by_source), default

    @classmethod
    def of(cls, given: "Maps") -> "StaticMaps":
        """Return maps as such; a grid is the map of every source, None is no map."""
        if isinstance(given, StaticMaps):
            return given
        return cls(default=None if given is None else StaticMap(given))

    def find(self, source: StaticMapSource) -> Optional[StaticMap]:
        """Return the map of a source; None if there is none yet."""
        return self._by_source.get(source, self._default)

    def with_map(self, source: StaticMapSource, static_map: StaticMap) -> "StaticMaps":
        """Return these maps with another one of a source."""
        return StaticMaps({**self._by_source, source: static_map}, self._default)


Maps = Union[None, OccupancyGrid, StaticMaps]
