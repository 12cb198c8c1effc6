"""The back end: key scans as nodes of a pose graph, and the search for loop closures among them.

The search is cut out as a task that holds all it needs by value, so that it can run in another thread while
the front end goes on: ``result = back_end.task().run()``, then ``back_end.adopt(result)``.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Iterator, List, Optional, Sequence, Tuple

import numpy as np

from planar import Pose2, wrap
from slam_lite.config import MapperSettings
from slam_lite.graph.certainty import Certainty
from slam_lite.graph.drift import drift_along, on_average, shortest_ways
from slam_lite.graph.pose_graph import Edge, EdgeList, Edges, between, chi_squares, edges_of, optimise
from slam_lite.loops.loop_closure import (
    Candidate,
    Closure,
    agree,
    are_out_of_reach,
    candidates,
    contradict,
    find_closure,
    is_confirmed,
    is_credible,
    lengths_of,
    recognised,
)
from slam_lite.loops.place_recognition import (
    Appearance,
    Hypothesis,
    Memory,
    hypotheses,
    remembered,
    ways_along,
)
from slam_lite.loops.relocation import KnownMap
from slam_lite.loops.ways_back import ways_back
from slam_lite.matching.local_map import LocalMap, wide_map
from slam_lite.surface import Surface

# Errors that a match's own information knows nothing of: between consecutive keys, and across a closure.
_STEP_SIGMA_XY, _STEP_SIGMA_YAW = 0.01, 0.003
_CLOSURE_SIGMA_XY, _CLOSURE_SIGMA_YAW = 0.02, 0.005
# How well a robot that goes on from a saved map is believed to be placed; and one of which nothing is known.
_GUESS_SIGMA_XY, _GUESS_SIGMA_YAW = 0.5, 0.3
_LOST_SIGMA_XY, _LOST_SIGMA_YAW = 1e3, 1e2
# Key scans that are put together to find a lost robot, and how far beside the map it is put until then.
_LOST_KEYS, _BESIDE = 20, 30.0
# A new closure with a larger chi-square, or this many smaller ones, are worth an optimisation.
_NEWS_CHI_SQUARE, _NEWS_COUNT = 10.0, 20
_MAX_PENDING = 50
# A closure that differs by so much from what the graph knows, as chi-square, needs a witness: what the graph
# knows is told cautiously, and of the right ones not one in a hundred does.
_SURPRISING = 6.0
# Places that look alike, searched for a closure after one look.
_MAX_RECOGNISED = 3
# When to end an optimisation, metres and radians: while mapping, and in the end.
_ROUGHLY, _EXACTLY = 5e-3, 1e-5
# How often ways driven again are looked for, and which chi-square says that one was not.
_LOOKS_BACK, _UNMET_CHI_SQUARE = 2, 16.0


@dataclass(frozen=True, eq=False)
class ClosureResult:
    """What a task found: new loop ``edges``, the ``poses`` (N, 3) of the keys that it knew.

    ``pending``, ``memory``: what the next task is to know; ``moved``: the poses are new.
    """

    edges: Sequence[Edge]
    poses: np.ndarray
    pending: Sequence[Closure]
    memory: Memory
    moved: bool


@dataclass(frozen=True, eq=False)
class ClosureTask:
    """The search for closures of the newest of some keys, and the optimisation if there is news.

    ``lost_since``: the first key of a trajectory that is not yet joined with those before, if it is not.
    """

    settings: MapperSettings
    local_map: LocalMap
    surfaces: Sequence[Surface]
    poses: np.ndarray
    edges: Edges
    pending: Sequence[Closure]
    memory: Memory
    unsettled: int
    lost_since: Optional[int]

    def run(self) -> ClosureResult:
        """Does the work; touches nothing but ``local_map``."""
        accepted: List[Closure] = []
        pending = list(self.pending)
        memory, alike = self._look()
        for closure in self._found(alike):
            witnesses = [other for other in pending if agree(closure, other, self.poses)]
            believed: Sequence[Closure] = ()
            if is_confirmed(closure, witnesses, self.poses) and not self._is_disputed(
                closure, witnesses, pending
            ):
                believed = self._believed([closure, *witnesses])
            if closure in believed:
                accepted += believed
                pending = [other for other in pending if other not in believed]
            else:
                pending = [*pending[1 - _MAX_PENDING :], closure]
        edges = [_told(closure) for closure in accepted]
        if not self._is_news(edges):
            return ClosureResult(edges, self.poses, pending, memory, False)
        poses = optimise(self._joined(edges), _with(self.edges, edges), _ROUGHLY, fresh=len(edges))
        return ClosureResult(edges, poses, pending, memory, True)

    def _found(self, alike: Sequence[Candidate]) -> Iterator[Closure]:
        """All closures of the newest key, whether they are believed or not."""
        near = candidates(len(self.poses) - 1, self.poses, self.edges, self.settings)
        for candidate in (*near, *alike):
            closure = find_closure(candidate, self.poses, self.surfaces, self.local_map, self.settings)
            if closure is not None:
                yield closure if closure.witnesses_needed else self._weighed(closure)
        if self.lost_since is not None:
            known = KnownMap(self.surfaces[: self.lost_since], self.poses[: self.lost_since], self.local_map)
            closure = known.closure(
                self.surfaces, self.poses, min(_LOST_KEYS, len(self.poses) - self.lost_since)
            )
            if closure is not None:
                yield closure

    def _weighed(self, closure: Closure) -> Closure:
        """The closure, and whether it surprises the graph."""
        return replace(closure, is_surprising=self._certainty.is_surprised_by(_told(closure), _SURPRISING))

    def _believed(self, group: Sequence[Closure]) -> List[Closure]:
        """Those of some that say the same which surprise the graph no more when it knows the others."""
        return [one for one in group if not (one.is_surprising and self._surprises_still(one, group))]

    def _surprises_still(self, closure: Closure, group: Sequence[Closure]) -> bool:
        others = [_told(other) for other in group if other is not closure]
        edges = _with(self.edges, others)
        poses = optimise(self.poses, edges, _ROUGHLY, fresh=len(others))
        return Certainty(poses, edges, closure.edge.second).is_surprised_by(_told(closure), _SURPRISING)

    @cached_property
    def _certainty(self) -> Certainty:
        """How surely the graph knows where the newest key is."""
        return Certainty(self.poses, self.edges, len(self.poses) - 1)

    def _joined(self, edges: Sequence[Edge]) -> np.ndarray:
        """The poses (N, 3), with a lost trajectory moved to where one of ``edges`` puts it."""
        for edge in edges:
            if self.lost_since is not None and edge.first < self.lost_since <= edge.second:
                place, recent = (Pose2.from_array(self.poses[key]) for key in (edge.first, edge.second))
                move = place @ edge.second_in_first @ recent.inverse()
                poses = self.poses.copy()
                poses[self.lost_since :, :2] = move.transform_points(poses[self.lost_since :, :2])
                poses[self.lost_since :, 2] = wrap(poses[self.lost_since :, 2] + move.yaw)
                return poses
        return self.poses

    def _look(self) -> Tuple[Memory, List[Candidate]]:
        """What to remember of the places passed since the last look, and where it looked alike before."""
        memory, ways = self.memory, ways_along(self.poses)
        alike: List[Candidate] = []
        stretch = memory.next_stretch(ways)
        while stretch is not None:
            place = stretch.appearance(self.surfaces, self.poses)
            look = [] if place is None else self._credible(place, memory)
            seen = memory.confirmed(look, self.poses)
            step = between(self.poses, stretch.middle, stretch.last)
            count = stretch.last - stretch.first + 1
            alike = [
                recognised(hypothesis.place, stretch.last, count, hypothesis.recent_in_place @ step)
                for hypothesis in seen[:_MAX_RECOGNISED]
            ]
            memory = memory.after(stretch, place, look)
            stretch = memory.next_stretch(ways)
        return memory, alike

    def _credible(self, recent: Appearance, memory: Memory) -> List[Hypothesis]:
        """Where the robot may be by what it looks like, among what the other search does not reach."""
        ways, before = shortest_ways(recent.key, len(self.poses), self.edges, lengths_of(self.edges))
        drift = np.column_stack(drift_along(ways, before, self.poses, on_average(self.edges)))
        keys = [place.key for place in memory.places]
        are_out = are_out_of_reach(ways[keys], drift[keys])
        places = [place for place, is_out in zip(memory.places, are_out) if is_out]
        return [
            hypothesis
            for hypothesis in hypotheses(recent, places)
            if is_credible(hypothesis, self.poses, drift[hypothesis.place])
        ]

    def _is_disputed(self, closure: Closure, witnesses: Sequence[Closure], others: Sequence[Closure]) -> bool:
        """Whether too many say that a place that was but recognised is another one."""
        if not closure.candidate.is_recognised:
            return False
        against = sum(contradict(closure, other, self.poses) for other in others)
        return len(witnesses) < 2 * against

    def _is_news(self, edges: Sequence[Edge]) -> bool:
        if not edges:
            return False
        if self.unsettled + len(edges) >= _NEWS_COUNT:
            return True
        return bool(chi_squares(self.poses, edges_of(*edges)).max() > _NEWS_CHI_SQUARE)


class BackEnd:
    """Places key scans in the map; every key is a node of the graph."""

    def __init__(self, settings: MapperSettings):
        self._settings = settings
        self._local_map = wide_map()
        self.surfaces: List[Surface] = []
        self._edges = EdgeList()
        self._poses = np.empty((0, 3))
        self._pending: Sequence[Closure] = ()
        self._memory = Memory()
        self._unsettled = 0
        self._lost_since: Optional[int] = None

    def __len__(self) -> int:
        return len(self.surfaces)

    @property
    def poses(self) -> np.ndarray:
        """Poses (N, 3) of the keys in the map; a view that later calls change."""
        return self._poses[: len(self)]

    @property
    def edges(self) -> Edges:
        """All edges of the graph."""
        return self._edges.view()

    def pose(self, key: int) -> Pose2:
        """Where a key lies in the map."""
        return Pose2.from_array(self._poses[key])

    def place_of(self, surface: Surface, believed: Pose2, only_near: bool) -> Optional[Pose2]:
        """Where a scan was taken, looked for around ``believed`` first; None if it cannot be told."""
        known = KnownMap(self.surfaces, self.poses, self._local_map)
        recent = [(surface, Pose2())]
        return known.find_near(recent, believed) if only_near else known.find(recent, believed)

    def beside(self, surface: Surface) -> Pose2:
        """A pose from which a scan sees nothing of what was seen so far."""
        ends = [(pose[0] + _reach(known), pose[1]) for known, pose in zip(self.surfaces, self.poses)]
        end, y = max(ends, default=(0.0, 0.0))
        return Pose2(end + _BESIDE + _reach(surface), y, 0.0)

    def add_first(self, surface: Surface, base_in_map: Pose2, is_lost: bool = False) -> None:
        """Adds the first key of a trajectory.

        Its tie to the key before, if there is one, is but a guess, or nothing at all if the robot is lost.
        """
        last_in_map = self.pose(len(self) - 1) if len(self) else None
        self._append(surface, base_in_map)
        if last_in_map is not None:
            last = len(self) - 2
            xy, yaw = (_LOST_SIGMA_XY, _LOST_SIGMA_YAW) if is_lost else (_GUESS_SIGMA_XY, _GUESS_SIGMA_YAW)
            tie = np.diag([xy**-2, xy**-2, yaw**-2])
            self._edges.append(Edge(last, last + 1, last_in_map.inverse() @ base_in_map, tie))
            self._lost_since = last + 1 if is_lost else None
            self._memory = self._memory.anew(len(self) - 1)

    def restore(self, surfaces: Sequence[Surface], poses: np.ndarray, edges: Edges) -> None:
        """Takes over the keys and edges of a saved graph, while there are none."""
        self.surfaces = list(surfaces)
        self._poses = poses.copy()
        self._edges = EdgeList(edges)
        self._memory = remembered(self.surfaces, self.poses)

    def _append(self, surface: Surface, base_in_map: Pose2) -> None:
        n = len(self)
        if n == len(self._poses):
            self._poses = np.concatenate((self._poses, np.empty((max(n, 64), 3))))
        self._poses[n] = base_in_map.as_array()
        self.surfaces.append(surface)

    def add(self, surface: Surface, base_in_last: Pose2, information: np.ndarray) -> None:
        """Adds a key seen from the last key at ``base_in_last``; ``information`` (3, 3) along last's axes."""
        last = len(self) - 1
        self._append(surface, self.pose(last) @ base_in_last)
        edge = Edge(last, last + 1, base_in_last, information)
        self._edges.append(_widened(edge, _STEP_SIGMA_XY, _STEP_SIGMA_YAW))

    def task(self) -> ClosureTask:
        """The search for closures of the newest key, as of now. One at a time: they share a local map."""
        return ClosureTask(
            self._settings,
            self._local_map,
            tuple(self.surfaces),
            self.poses.copy(),
            self.edges,
            self._pending,
            self._memory,
            self._unsettled,
            self._lost_since,
        )

    def adopt(self, result: ClosureResult) -> None:
        """Takes over what a task found; keys added since move along with the last one that it knew."""
        known = len(result.poses)
        if result.moved:
            last = known - 1
            moved = Pose2.from_array(result.poses[last]) @ self.pose(last).inverse()
            for key in range(known, len(self)):
                self._poses[key] = (moved @ self.pose(key)).as_array()
            self._poses[:known] = result.poses
        for edge in result.edges:
            self._edges.append(edge)
            if self._lost_since is not None and edge.first < self._lost_since <= edge.second:
                self._lost_since = None
        self._pending = result.pending
        if known > self._memory.start:  # otherwise a new way has begun since
            self._memory = result.memory
        self._unsettled = 0 if result.moved else self._unsettled + len(result.edges)

    def settle(self) -> None:
        """Optimises to the end, and ties ways that were driven again."""
        poses, found = optimise(self.poses, self.edges, _EXACTLY), []
        for _ in range(_LOOKS_BACK if self._settings.close_loops else 0):
            found = ways_back(poses, self.edges, self.surfaces, self._local_map)
            if not found:
                break
            poses = optimise(poses, _with(self.edges, found), _EXACTLY, fresh=len(found))
        for edge, chi in zip(found, chi_squares(poses, edges_of(*found))):
            if chi < _UNMET_CHI_SQUARE:
                self._edges.append(edge)
        self._poses[: len(self)] = poses
        self._unsettled = 0


def _reach(surface: Surface) -> float:
    """How far a scan sees, metres."""
    return float(np.sqrt((surface.points_xy**2).sum(axis=1).max(initial=0.0)))


def _with(edges: Edges, more: Sequence[Edge]) -> Edges:
    pairs = zip(vars(edges).values(), vars(edges_of(*more)).values())
    return Edges(*(np.concatenate(pair) for pair in pairs))


def _told(closure: Closure) -> Edge:
    return _widened(closure.edge, _CLOSURE_SIGMA_XY, _CLOSURE_SIGMA_YAW)


def _widened(edge: Edge, sigma_xy: float, sigma_yaw: float) -> Edge:
    """The edge with independent errors of its own added to those of the match."""
    own = np.diag([sigma_xy**-2, sigma_xy**-2, sigma_yaw**-2])
    # Woodbury's identity: what the match knows nothing of has no covariance to add to.
    told = edge.information
    told = told - told @ np.linalg.solve(own + told, told)
    return Edge(edge.first, edge.second, edge.second_in_first, told, edge.is_loop)
