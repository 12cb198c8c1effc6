"""People who walk about, each in their own way, others for each seed."""

from dataclasses import dataclass, replace
from typing import Any, Iterator, NamedTuple, Sequence, Tuple

import numpy as np

from laboratory.worlds.source import Arena
from planar import FREE, OccupancyGrid, Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.geometry.distance_field import distance_field
from sim_bridge.people.walker import Walker
from sim_bridge.views.true_map import true_map

# Metres: from where a person walks to or stands to what is solid; to where the robot starts, and from where
# somebody stands for good to where it has to go; between people at the start.
TO_WALL, TO_START, TO_PLACES, APART = 0.5, 1.5, 1.2, 0.9
# Places that each walks between, and how long one stays there at most, seconds.
GOALS, LONGEST_REST = 4, 4.0
# Of people who are only counted: the share of children, of those who stand, and of adults with company.
CHILDREN, STANDING, IN_COMPANY = 0.25, 0.15, 0.3
MOST_PEOPLE = 40
_STREAM = 46


class _Kind(NamedTuple):
    """``speed``: m/s, mean, standard deviation, least and greatest; the rest in metres."""

    speed: Tuple[float, float, float, float]
    radius: float
    height: float


_ADULT = _Kind((1.0, 0.2, 0.6, 1.4), 0.2, 1.7)
# Who run more than they walk.
_CHILD = _Kind((1.3, 0.3, 0.8, 1.8), 0.15, 1.1)


@dataclass(frozen=True)
class Walk:
    """Of one adult, from place to place, x and y of each, at a ``speed``, m/s."""

    goals: Tuple[Tuple[float, float], ...]
    speed: float = _ADULT.speed[0]


@dataclass(frozen=True)
class People:
    """How many: ``adults`` who walk alone, ``children``, ``standing``; ``groups``: how many walk together.

    ``anyone``: people of whom the seed says what they are. ``walks``: of people of whom all is known.
    """

    adults: int = 0
    children: int = 0
    standing: int = 0
    groups: Tuple[int, ...] = ()
    anyone: int = 0
    walks: Tuple[Walk, ...] = ()

    @property
    def count(self) -> int:
        return self.adults + self.children + self.standing + sum(self.groups) + self.anyone + len(self.walks)

    def drawn(self, rng: np.random.Generator) -> "People":
        """The same with nobody left of whom it is not known what they are."""
        adults, children, standing, pairs, left = self.adults, self.children, self.standing, 0, self.anyone
        while left:
            chance = rng.random()
            if chance < CHILDREN:
                children, left = children + 1, left - 1
            elif chance < CHILDREN + STANDING:
                standing, left = standing + 1, left - 1
            elif left > 1 and rng.random() < IN_COMPANY:
                pairs, left = pairs + 1, left - 2
            else:
                adults, left = adults + 1, left - 1
        return People(adults, children, standing, (*self.groups, *(2,) * pairs), walks=self.walks)


def with_people(arena: Arena, people: People, seed: int, start: Pose2, places: Sequence[Pose2] = ()) -> Arena:
    """The arena with people in it, off the ``start`` of the robot; nobody stands for good at its ``places``.

    Raises SettingsError if there is no room for them.
    """
    rng = np.random.default_rng([seed, _STREAM])
    spots = _Spots(true_map(arena.world, inside=(start.x, start.y)), start, places, rng)
    drawn = people.drawn(rng)
    walkers = [
        Walker(f"person_{number}", np.array(walk.goals, dtype=float), walk.speed)
        for number, walk in enumerate(people.walks)
    ]
    for number, (kind, size) in enumerate(_parties(drawn), 1):
        goals_xy = spots.goals()
        for _ in range(size):
            own = np.vstack([[spots.start_near(goals_xy[0])], goals_xy[1:]])
            walkers.append(_walker(len(walkers), kind, own, number if size > 1 else 0, rng))
    for _ in range(drawn.standing):
        own = np.array([spots.place_to_stand()])
        walkers.append(_walker(len(walkers), _ADULT, own, 0, rng))
    return replace(arena, world=replace(arena.world, walkers=tuple(walkers)))


def _parties(people: People) -> Iterator[Tuple[_Kind, int]]:
    """Who walk, and how many of them together."""
    yield from ((_ADULT, 1) for _ in range(people.adults))
    yield from ((_CHILD, 1) for _ in range(people.children))
    yield from ((_ADULT, size) for size in people.groups)


def _walker(number: int, kind: _Kind, goals_xy: np.ndarray, group: int, rng: np.random.Generator) -> Walker:
    mean, deviation, least, greatest = kind.speed
    speed = float(np.clip(rng.normal(mean, deviation), least, greatest))
    rest = float(rng.uniform(0.0, LONGEST_REST))
    return Walker(f"person_{number}", goals_xy, speed, rest, group, kind.radius, kind.height)


class _Spots:
    """Where there is room for people, who come to each other from any of these."""

    def __init__(self, grid: OccupancyGrid, start: Pose2, places: Sequence[Pose2], rng: np.random.Generator):
        clearance = distance_field(grid.cells != FREE, grid.resolution)
        self._all_xy = grid.points_of(np.argwhere(clearance > TO_WALL))
        self._free_xy = self._all_xy[_far_from(self._all_xy, (start.x, start.y), TO_START)]
        self._places, self._rng = places, rng

    def goals(self) -> np.ndarray:
        """The first has nobody near it yet."""
        first = self._one_of(self._free_xy)
        return np.array([first, *(self._one_of(self._all_xy) for _ in range(GOALS - 1))])

    def start_near(self, goal_xy: np.ndarray) -> np.ndarray:
        """The nearest spot that nobody has taken yet; now it is taken."""
        if not len(self._free_xy):
            raise SettingsError("there is no room for so many people")
        spot = self._free_xy[int(np.argmin(np.hypot(*(self._free_xy - goal_xy).T)))]
        self._free_xy = self._free_xy[_far_from(self._free_xy, spot, APART)]
        return spot

    def place_to_stand(self) -> np.ndarray:
        """In nobody's way who has to go to one of the places."""
        free_xy = self._free_xy
        for place in self._places:
            free_xy = free_xy[_far_from(free_xy, (place.x, place.y), TO_PLACES)]
        return self.start_near(self._one_of(free_xy))

    def _one_of(self, spots_xy: np.ndarray) -> np.ndarray:
        if not len(spots_xy):
            raise SettingsError("there is no room for so many people")
        return spots_xy[self._rng.integers(len(spots_xy))]


def _far_from(spots_xy: np.ndarray, point: Any, distance: float) -> np.ndarray:
    """Which of some spots (N, 2) are, bool (N,)."""
    return np.hypot(*(spots_xy - np.asarray(point)).T) > distance


def read_people(happens: Table) -> People:
    """``people``: how many, or a table of who they are. Raises the table's error."""
    if "people" not in happens:
        return People()
    if isinstance(happens.value("people"), int):
        people = People(anyone=happens.count("people"))
    elif isinstance(happens.value("people"), list):
        people = People(walks=tuple(_walk(table) for table in happens.tables("people")))
    else:
        table = happens.table("people")
        table.allow_only("adults", "children", "standing", "groups")
        kinds = ("adults", "children", "standing")
        adults, children, standing = (table.count(key) if key in table else 0 for key in kinds)
        groups: Any = table.value("groups") if "groups" in table else []
        is_fine = isinstance(groups, list) and all(type(size) is int and size > 1 for size in groups)
        table.check(is_fine, "groups", "a list of how many walk together, each at least 2")
        people = People(adults, children, standing, tuple(groups))
    happens.check(people.count <= MOST_PEOPLE, "people", f"at most {MOST_PEOPLE}")
    return people


def _walk(table: Table) -> Walk:
    table.allow_only("goals", "speed")
    goals: Any = table.value("goals")
    try:
        goals_xy = np.array(goals, dtype=float).reshape(-1, 2)
    except (TypeError, ValueError):
        goals_xy = np.empty((0, 2))
    is_fine = len(goals_xy) > 0 and len(goals_xy) == len(goals) and bool(np.isfinite(goals_xy).all())
    table.check(is_fine, "goals", "a list of places, x and y of each")
    speed = table.number("speed", Walk.speed)
    table.check(0.0 < speed <= 5.0, "speed", "positive and at most 5 m/s")
    return Walk(tuple((x, y) for x, y in goals_xy.tolist()), speed)
