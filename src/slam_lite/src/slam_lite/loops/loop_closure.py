"""Loop closure verification: which loop closures are accepted into the pose graph.

A loop closure is accepted at once only if the graph already knew the place to within a small window.
Otherwise a second consistent one nearby has to confirm it. If the place was found by place recognition alone,
two have to, and together they have to outweigh the number of places that might have been recognized: the more
a robot has mapped, the more likely two of them look alike.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Dict, Sequence, Tuple

import numpy as np

from slam_lite.graph.node_covariance import NodeCovariance
from slam_lite.graph.pose_graph import COARSE, Edge, Edges, concatenate, inflate, optimize, relative_pose
from slam_lite.loops.cycle_consistency import cycle_error, rotated
from slam_lite.loops.degeneracy import PARALLEL
from slam_lite.loops.loop_candidates import RECENT_PATH, LoopCandidate

# Loop closures found in windows up to this size [m] need no confirmation.
_FAMILIAR_DISTANCE = 1.0
# Log likelihood ratio from which on other ones of an unambiguous candidate need none either.
CERTAIN_RATIO = 2.0
# Largest distance between two loop closures that share no scan and yet concern the same segment [m].
_MAX_WITNESS_DISTANCE = 15.0
# Distance over which a recognized place has to be similar [m]: crossings of corridors resemble each other.
_MIN_RECOGNIZED_DISTANCE = 11.0
# Difference [m] above which two loop closures place the robot differently.
_CONTRADICTION = 3.0
# Errors of a loop closure that its match does not include: metres and radians.
SIGMA_XY, SIGMA_YAW = 0.02, 0.005
# Chi-square, given the graph's covariance, above which a loop closure needs confirmation. The covariance is
# pessimistic: fewer than one in a hundred correct loop closures exceed it.
_MAX_CHI_SQUARE = 6.0


@dataclass(frozen=True, eq=False)
class LoopClosure:
    """Measurement of a recent keyframe's pose in an older keyframe.

    Attributes:
        edge: Edge from the older keyframe to the recent one.
        candidate: Candidate at which it was found.
        degenerate_direction: Unit vector (2,), along the axes of ``edge.first``, in which the edge has no
            information, as along a smooth corridor; zeros if there is none.
        log_likelihood_ratio: How much more likely the match is if both segments see the same place.
        contradicts_graph: Whether it is an outlier given the covariance of the graph.
    """

    edge: Edge
    candidate: LoopCandidate
    degenerate_direction: np.ndarray
    log_likelihood_ratio: float = 0.0
    contradicts_graph: bool = False

    @property
    def graph_edge(self) -> Edge:
        """Edge to add to the graph, with the errors that the match does not include."""
        return inflate(self.edge, SIGMA_XY, SIGMA_YAW)

    @property
    def witnesses_needed(self) -> int:
        """Number of further consistent loop closures that are needed to confirm it."""
        if self.candidate.is_recognized:
            return 2
        is_familiar = self.candidate.window.distance <= _FAMILIAR_DISTANCE or self._is_certain
        return 0 if is_familiar and not self.contradicts_graph else 1

    @property
    def _is_certain(self) -> bool:
        """Whether the match alone shows that it is the place near which the graph expects the robot."""
        is_near = not self.candidate.is_ambiguous and not self.degenerate_direction.any()
        return is_near and self.log_likelihood_ratio >= CERTAIN_RATIO


class LoopClosureVerifier:
    """Decides which loop closures of the newest keyframe are added to the graph."""

    def __init__(self, poses: np.ndarray, edges: Edges):
        """Set the graph.

        Args:
            poses: (N, 3), poses of all keyframes in the map frame.
            edges: Edges of the graph.
        """
        self._poses, self._edges = poses, edges

    def check_against_graph(self, closure: LoopClosure) -> LoopClosure:
        """Return the loop closure with ``contradicts_graph`` set, unless it needs confirmation anyway.

        Args:
            closure: Loop closure of the newest keyframe.
        """
        if closure.witnesses_needed:
            return closure
        is_outlier = self._covariance.is_outlier(closure.graph_edge, _MAX_CHI_SQUARE)
        return replace(closure, contradicts_graph=is_outlier)

    def verify(self, closure: LoopClosure, pending: Sequence[LoopClosure]) -> Sequence[LoopClosure]:
        """Verify a loop closure with earlier ones.

        Args:
            closure: The new loop closure.
            pending: Earlier ones that are not verified yet.

        Returns:
            The loop closures to accept: the new one and those that confirm it, or none.
        """
        witnesses = [other for other in pending if agree(closure, other, self._poses)]
        if not _is_confirmed(closure, witnesses, self._poses):
            return ()
        if self._is_disputed(closure, witnesses, pending):
            return ()
        group = [closure, *witnesses]
        accepted = [
            one for one in group if not (one.contradicts_graph and self._still_contradicts(one, group))
        ]
        return accepted if closure in accepted else ()

    @cached_property
    def _covariance(self) -> NodeCovariance:
        """Covariance of the newest keyframe."""
        return NodeCovariance(self._poses, self._edges, len(self._poses) - 1)

    def _still_contradicts(self, closure: LoopClosure, group: Sequence[LoopClosure]) -> bool:
        """Whether a loop closure is an outlier also in a graph with the others of its group."""
        others = [other.graph_edge for other in group if other is not closure]
        edges = concatenate(self._edges, others)
        poses = optimize(self._poses, edges, COARSE, new_count=len(others))
        covariance = NodeCovariance(poses, edges, closure.edge.second)
        return covariance.is_outlier(closure.graph_edge, _MAX_CHI_SQUARE)

    def _is_disputed(
        self, closure: LoopClosure, witnesses: Sequence[LoopClosure], others: Sequence[LoopClosure]
    ) -> bool:
        """Whether too many others contradict the place of a recognized loop closure."""
        if not closure.candidate.is_recognized:
            return False
        contradicting = sum(contradict(closure, other, self._poses) for other in others)
        return len(witnesses) < 2 * contradicting


def agree(one: LoopClosure, other: LoopClosure, poses: np.ndarray) -> bool:
    """Check whether two loop closures between the same two segments are consistent.

    Around the cycle place - recent - other recent - other place - place the errors must cancel, up to the
    drift of the front end between them and up to the direction in which both may be degenerate. A degenerate
    loop closure cannot confirm one that is not: it does not measure the position along the corridor.

    Args:
        one: Loop closure to confirm.
        other: Loop closure that may confirm it.
        poses: (N, 3), poses of all keyframes in the map frame.
    """
    recent_distance, place_distance, error, turn = _disagreement(one, other, poses)
    if not RECENT_PATH <= recent_distance <= _MAX_WITNESS_DISTANCE:
        return False
    direction = one.degenerate_direction
    if direction.any() != other.degenerate_direction.any():
        return False
    if direction.any() and abs(direction @ _degenerate_direction_in(one, other, poses)) < PARALLEL:
        return False
    distance = recent_distance + place_distance
    return error < 0.15 + 0.02 * distance and turn < 0.05 + 0.005 * distance


def contradict(one: LoopClosure, other: LoopClosure, poses: np.ndarray) -> bool:
    """Check whether two loop closures of the same segment place it differently.

    Args:
        one: A loop closure.
        other: Another loop closure.
        poses: (N, 3), poses of all keyframes in the map frame.
    """
    recent_distance, place_distance, error, turn = _disagreement(one, other, poses)
    if recent_distance > _MAX_WITNESS_DISTANCE:
        return False
    distance = recent_distance + place_distance
    return error > _CONTRADICTION + 0.1 * distance or turn > 0.3


def _is_confirmed(closure: LoopClosure, witnesses: Sequence[LoopClosure], poses: np.ndarray) -> bool:
    """Whether enough others are consistent.

    For a recognized place, one of them must be far away, and the likelihood ratio of all together must exceed
    the number of alternatives.
    """
    if len(witnesses) < closure.witnesses_needed:
        return False
    if not closure.candidate.is_recognized:
        return True
    distances = [_disagreement(closure, other, poses)[0] for other in witnesses]
    # Loop closures of one keyframe to several places nearby are not independent.
    best: Dict[int, float] = {}
    for one in (closure, *witnesses):
        best[one.edge.second] = max(best.get(one.edge.second, 0.0), one.log_likelihood_ratio)
    is_likely = sum(best.values()) >= math.log(max(closure.candidate.alternatives, 1.0))
    return max(distances) >= _MIN_RECOGNIZED_DISTANCE and is_likely


def _disagreement(
    one: LoopClosure, other: LoopClosure, poses: np.ndarray
) -> Tuple[float, float, float, float]:
    """Distances between the recent keyframes and between the places, and the error around their cycle.

    Errors along a degenerate direction do not count.
    """
    a, b = one.edge, other.edge
    recent_step = relative_pose(poses, a.second, b.second)
    place_step = relative_pose(poses, a.first, b.first)
    directions = one.degenerate_direction, other.degenerate_direction
    error, turn = cycle_error(a, b, recent_step, place_step, *directions)
    recent_distance, place_distance = (math.hypot(step.x, step.y) for step in (recent_step, place_step))
    return recent_distance, place_distance, error, turn


def _degenerate_direction_in(frame: LoopClosure, closure: LoopClosure, poses: np.ndarray) -> np.ndarray:
    """The degenerate direction (2,) of a loop closure along the axes of another one's place."""
    place_step = relative_pose(poses, frame.edge.first, closure.edge.first)
    return rotated(closure.degenerate_direction, place_step.yaw)
