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
WALL_CLEARANCE, START_CLEARANCE, GOAL_CLEARANCE, APART = 0.5, 1.5, 1.2, 0.9
# Places that each walks between, and how long one stays there at most, seconds.
GOALS, MAX_PAUSE = 4, 4.0
# Of people who are only counted: the share of children, of those who stand, and of adults with company.
CHILD_SHARE, STANDING_SHARE, PAIR_SHARE = 0.25, 0.15, 0.3
MAX_PEDESTRIANS = 40
_STREAM = 46


class _PedestrianKind(NamedTuple):
    """``speed``: m/s, mean, standard deviation, least and greatest; the rest in metres."""

    speed: Tuple[float, float, float, float]
    radius: float
    height: float


_ADULT = _PedestrianKind((1.0, 0.2, 0.6, 1.4), 0.2, 1.7)
# Who run more than they walk.
_CHILD = _PedestrianKind((1.3, 0.3, 0.8, 1.8), 0.15, 1.1)


@dataclass(frozen=True)
class PedestrianRoute:
    """Of one adult, from place to place, x and y of each, at a ``speed``, m/s."""

    goals: Tuple[Tuple[float, float], ...]
    speed: float = _ADULT.speed[0]


@dataclass(frozen=True)
class Pedestrians:
    """How many: ``adults`` who walk alone, ``children``, ``standing``; ``groups``: how many walk together.

    ``anyone``: people of whom the seed says what they are. ``walks``: of people of whom all is known.
    """

    adults: int = 0
    children: int = 0
    standing: int = 0
    groups: Tuple[int, ...] = ()
    unspecified: int = 0
    routes: Tuple[PedestrianRoute, ...] = ()

    @property
    def count(self) -> int:
        return (
            self.adults
            + self.children
            + self.standing
            + sum(self.groups)
            + self.unspecified
            + len(self.routes)
        )

    def resolved(self, rng: np.random.Generator) -> "Pedestrians":
        """The same with nobody left of whom it is not known what they are."""
        adults, children, standing, pairs, left = (
            self.adults,
            self.children,
            self.standing,
            0,
            self.unspecified,
        )
        while left:
            chance = rng.random()
            if chance < CHILD_SHARE:
                children, left = children + 1, left - 1
            elif chance < CHILD_SHARE + STANDING_SHARE:
                standing, left = standing + 1, left - 1
            elif left > 1 and rng.random() < PAIR_SHARE:
                pairs, left = pairs + 1, left - 2
            else:
                adults, left = adults + 1, left - 1
        return Pedestrians(adults, children, standing, (*self.groups, *(2,) * pairs), routes=self.routes)


def with_people(
    arena: Arena, people: Pedestrians, seed: int, start: Pose2, places: Sequence[Pose2] = ()
) -> Arena:
    """The arena with people in it, off the ``start`` of the robot; nobody stands for good at its ``places``.

    Raises SettingsError if there is no room for them.
    """
    rng = np.random.default_rng([seed, _STREAM])
    spawn_points = _SpawnPoints(true_map(arena.world, inside=(start.x, start.y)), start, places, rng)
    resolved = people.resolved(rng)
    walkers = [
        Walker(f"person_{number}", np.array(walk.goals, dtype=float), walk.speed)
        for number, walk in enumerate(people.routes)
    ]
    for number, (kind, size) in enumerate(_walking_groups(resolved), 1):
        goals_xy = spawn_points.goals()
        for _ in range(size):
            goals_of_member = np.vstack([[spawn_points.claim_nearest(goals_xy[0])], goals_xy[1:]])
            walkers.append(_walker(len(walkers), kind, goals_of_member, number if size > 1 else 0, rng))
    for _ in range(resolved.standing):
        goals_of_member = np.array([spawn_points.claim_standing()])
        walkers.append(_walker(len(walkers), _ADULT, goals_of_member, 0, rng))
    return replace(arena, world=replace(arena.world, walkers=tuple(walkers)))


def _walking_groups(people: Pedestrians) -> Iterator[Tuple[_PedestrianKind, int]]:
    """Who walk, and how many of them together."""
    yield from ((_ADULT, 1) for _ in range(people.adults))
    yield from ((_CHILD, 1) for _ in range(people.children))
    yield from ((_ADULT, size) for size in people.groups)


def _walker(
    number: int, kind: _PedestrianKind, goals_xy: np.ndarray, group: int, rng: np.random.Generator
) -> Walker:
    mean, deviation, least, greatest = kind.speed
    speed = float(np.clip(rng.normal(mean, deviation), least, greatest))
    rest = float(rng.uniform(0.0, MAX_PAUSE))
    return Walker(f"person_{number}", goals_xy, speed, rest, group, kind.radius, kind.height)


class _SpawnPoints:
    """Where there is room for people, who come to each other from any of these."""

    def __init__(self, grid: OccupancyGrid, start: Pose2, places: Sequence[Pose2], rng: np.random.Generator):
        clearance = distance_field(grid.cells != FREE, grid.resolution)
        self._all_xy = grid.points_of(np.argwhere(clearance > WALL_CLEARANCE))
        self._free_xy = self._all_xy[_is_far_from(self._all_xy, (start.x, start.y), START_CLEARANCE)]
        self._places, self._rng = places, rng

    def goals(self) -> np.ndarray:
        """The first has nobody near it yet."""
        first = self._sample(self._free_xy)
        return np.array([first, *(self._sample(self._all_xy) for _ in range(GOALS - 1))])

    def claim_nearest(self, goal_xy: np.ndarray) -> np.ndarray:
        """The nearest spot that nobody has taken yet; now it is taken."""
        if not len(self._free_xy):
            raise SettingsError("there is no room for so many people")
        spot = self._free_xy[int(np.argmin(np.hypot(*(self._free_xy - goal_xy).T)))]
        self._free_xy = self._free_xy[_is_far_from(self._free_xy, spot, APART)]
        return spot

    def claim_standing(self) -> np.ndarray:
        """In nobody's way who has to go to one of the places."""
        free_xy = self._free_xy
        for place in self._places:
            free_xy = free_xy[_is_far_from(free_xy, (place.x, place.y), GOAL_CLEARANCE)]
        return self.claim_nearest(self._sample(free_xy))

    def _sample(self, points_xy: np.ndarray) -> np.ndarray:
        if not len(points_xy):
            raise SettingsError("there is no room for so many people")
        return points_xy[self._rng.integers(len(points_xy))]


def _is_far_from(points_xy: np.ndarray, point: Any, distance: float) -> np.ndarray:
    """Which of some spots (N, 2) are, bool (N,)."""
    return np.hypot(*(points_xy - np.asarray(point)).T) > distance


def read_people(happens: Table) -> Pedestrians:
    """``people``: how many, or a table of who they are. Raises the table's error."""
    if "people" not in happens:
        return Pedestrians()
    if isinstance(happens.value("people"), int):
        people = Pedestrians(unspecified=happens.count("people"))
    elif isinstance(happens.value("people"), list):
        people = Pedestrians(routes=tuple(_read_route(table) for table in happens.tables("people")))
    else:
        table = happens.table("people")
        table.allow_only("adults", "children", "standing", "groups")
        kinds = ("adults", "children", "standing")
        adults, children, standing = (table.count(key) if key in table else 0 for key in kinds)
        groups: Any = table.value("groups") if "groups" in table else []
        is_fine = isinstance(groups, list) and all(type(size) is int and size > 1 for size in groups)
        table.check(is_fine, "groups", "a list of how many walk together, each at least 2")
        people = Pedestrians(adults, children, standing, tuple(groups))
    happens.check(people.count <= MAX_PEDESTRIANS, "people", f"at most {MAX_PEDESTRIANS}")
    return people


def _read_route(table: Table) -> PedestrianRoute:
    table.allow_only("goals", "speed")
    goals: Any = table.value("goals")
    try:
        goals_xy = np.array(goals, dtype=float).reshape(-1, 2)
    except (TypeError, ValueError):
        goals_xy = np.empty((0, 2))
    is_fine = len(goals_xy) > 0 and len(goals_xy) == len(goals) and bool(np.isfinite(goals_xy).all())
    table.check(is_fine, "goals", "a list of places, x and y of each")
    speed = table.number("speed", PedestrianRoute.speed)
    table.check(0.0 < speed <= 5.0, "speed", "positive and at most 5 m/s")
    return PedestrianRoute(tuple((x, y) for x, y in goals_xy.tolist()), speed)
