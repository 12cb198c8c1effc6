"""Pedestrians of scenarios, different ones for each seed."""

from dataclasses import dataclass, replace
from typing import Any, Iterator, NamedTuple, Sequence, Tuple

import numpy as np

from laboratory.worlds.source import Arena
from planar import FREE, OccupancyGrid, Pose2, SettingsError
from planar.config.error_list import read_each
from planar.config.yaml_table import Table
from planar.geometry.distance_field import distance_field
from sim_bridge.people.walker import Walker
from sim_bridge.views.true_map import true_map

# Minimum distances [m]: from goals of pedestrians to obstacles; from their start to the robot's start; from
# standing pedestrians to the robot's goals; between pedestrians at the start.
WALL_CLEARANCE, START_CLEARANCE, GOAL_CLEARANCE, SPACING = 0.5, 1.5, 1.2, 0.9
# Goals of each pedestrian, and the longest pause there [s].
GOALS, MAX_PAUSE = 4, 4.0
# Of pedestrians of an unspecified kind: share of children, of standing people, and of adults in pairs.
CHILD_SHARE, STANDING_SHARE, PAIR_SHARE = 0.25, 0.15, 0.3
MAX_PEDESTRIANS = 40
_STREAM = 46


class _PedestrianKind(NamedTuple):
    """``speed``: mean, standard deviation, minimum and maximum [m/s]; ``radius`` and ``height`` [m]."""

    speed: Tuple[float, float, float, float]
    radius: float
    height: float


_ADULT = _PedestrianKind((1.0, 0.2, 0.6, 1.4), 0.2, 1.7)
# Faster than adults.
_CHILD = _PedestrianKind((1.3, 0.3, 0.8, 1.8), 0.15, 1.1)


@dataclass(frozen=True)
class PedestrianRoute:
    """Fully specified pedestrian: an adult who walks between goals.

    Attributes:
        goals: x and y of each goal in the world frame [m].
        speed: Preferred speed [m/s].
    """

    goals: Tuple[Tuple[float, float], ...]
    speed: float = _ADULT.speed[0]


@dataclass(frozen=True)
class Pedestrians:
    """Number of pedestrians by kind.

    Attributes:
        adults: Adults who walk alone.
        children: Children.
        standing: Adults who stand still.
        groups: Size of each group that walks together.
        unspecified: Pedestrians whose kind depends on the seed.
        routes: Pedestrians with given goals.
    """

    adults: int = 0
    children: int = 0
    standing: int = 0
    groups: Tuple[int, ...] = ()
    unspecified: int = 0
    routes: Tuple[PedestrianRoute, ...] = ()

    @property
    def count(self) -> int:
        grouped, given = sum(self.groups), len(self.routes)
        return self.adults + self.children + self.standing + grouped + self.unspecified + given

    def resolved(self, rng: np.random.Generator) -> "Pedestrians":
        """Return the same pedestrians with a random kind for each unspecified one."""
        adults, children, standing = self.adults, self.children, self.standing
        pairs, left = 0, self.unspecified
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
    """Add pedestrians at random positions.

    Args:
        arena: Arena to add them to.
        people: Number of pedestrians by kind.
        seed: Seed of their kinds, goals and speeds.
        start: Start pose of the robot, which stays free.
        places: Poses where nobody stands still.

    Raises:
        SettingsError: There is not enough space.
    """
    rng = np.random.default_rng([seed, _STREAM])
    spawn_points = _SpawnPoints(true_map(arena.world, inside=(start.x, start.y)), start, places, rng)
    resolved = people.resolved(rng)
    walkers = [
        Walker(f"person_{number}", np.array(route.goals, dtype=float), route.speed)
        for number, route in enumerate(people.routes)
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
    """Kind and size of each walking group."""
    yield from ((_ADULT, 1) for _ in range(people.adults))
    yield from ((_CHILD, 1) for _ in range(people.children))
    yield from ((_ADULT, size) for size in people.groups)


def _walker(
    number: int, kind: _PedestrianKind, goals_xy: np.ndarray, group: int, rng: np.random.Generator
) -> Walker:
    mean, deviation, minimum, maximum = kind.speed
    speed = float(np.clip(rng.normal(mean, deviation), minimum, maximum))
    pause = float(rng.uniform(0.0, MAX_PAUSE))
    return Walker(f"person_{number}", goals_xy, speed, pause, group, kind.radius, kind.height)


class _SpawnPoints:
    """Free positions for pedestrians, all connected."""

    def __init__(self, grid: OccupancyGrid, start: Pose2, places: Sequence[Pose2], rng: np.random.Generator):
        clearance = distance_field(grid.cells != FREE, grid.resolution)
        self._all_xy = grid.points_of(np.argwhere(clearance > WALL_CLEARANCE))
        self._free_xy = self._all_xy[_is_far_from(self._all_xy, (start.x, start.y), START_CLEARANCE)]
        self._places, self._rng = places, rng

    def goals(self) -> np.ndarray:
        """Draw goals; nobody has been placed near the first."""
        first = self._sample(self._free_xy)
        return np.array([first, *(self._sample(self._all_xy) for _ in range(GOALS - 1))])

    def claim_nearest(self, goal_xy: np.ndarray) -> np.ndarray:
        """Return the nearest free position, and remove its surroundings from the free ones."""
        if not len(self._free_xy):
            raise SettingsError("there is not enough space for so many people")
        position = self._free_xy[int(np.argmin(np.hypot(*(self._free_xy - goal_xy).T)))]
        self._free_xy = self._free_xy[_is_far_from(self._free_xy, position, SPACING)]
        return position

    def claim_standing(self) -> np.ndarray:
        """Return a free position away from the robot's goals, for a standing pedestrian."""
        free_xy = self._free_xy
        for place in self._places:
            free_xy = free_xy[_is_far_from(free_xy, (place.x, place.y), GOAL_CLEARANCE)]
        return self.claim_nearest(self._sample(free_xy))

    def _sample(self, points_xy: np.ndarray) -> np.ndarray:
        if not len(points_xy):
            raise SettingsError("there is not enough space for so many people")
        return points_xy[self._rng.integers(len(points_xy))]


def _is_far_from(points_xy: np.ndarray, point: Any, distance: float) -> np.ndarray:
    """Which of the points (N, 2) are farther than ``distance`` from a point, bool (N,)."""
    return np.hypot(*(points_xy - np.asarray(point)).T) > distance


def read_people(happens: Table) -> Pedestrians:
    """Read ``people``: their number, numbers by kind, or a list of routes. Raises SettingsError."""
    if "people" not in happens:
        return Pedestrians()
    if isinstance(happens.value("people"), int):
        people = Pedestrians(unspecified=happens.count("people"))
    elif isinstance(happens.value("people"), list):
        people = Pedestrians(routes=read_each(_read_route, happens.tables("people")))
    else:
        table = happens.table("people")
        table.allow_only("adults", "children", "standing", "groups")
        kinds = ("adults", "children", "standing")
        adults, children, standing = (table.count(key) if key in table else 0 for key in kinds)
        groups: Any = table.value("groups") if "groups" in table else []
        is_fine = isinstance(groups, list) and all(type(size) is int and size > 1 for size in groups)
        table.check(is_fine, "groups", "a list of group sizes of at least 2")
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
    table.check(is_fine, "goals", "a list of [x, y]")
    speed = table.number("speed", PedestrianRoute.speed)
    table.check(0.0 < speed <= 5.0, "speed", "positive and at most 5 m/s")
    return PedestrianRoute(tuple((x, y) for x, y in goals_xy.tolist()), speed)
