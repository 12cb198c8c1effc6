"""Cross-sections of a world at one height, and ray casting in them."""

from dataclasses import dataclass
from typing import Callable, Dict, Optional, Sequence, Tuple

import numpy as np

from sim_bridge.geometry.slicing import slice_shape
from sim_bridge.world import Body

# Movement [m or rad] below which an outline is not recomputed: bodies at rest jitter, and slicing meshes
# takes time.
POSE_TOLERANCE = 5e-4


@dataclass(frozen=True, eq=False)
class _Outline:
    """Segments (N, 4) of a body's slice at a pose (4, 4), and their laser_retro (N,)."""

    body: Body
    computed_at: np.ndarray
    segments: np.ndarray
    retros: np.ndarray


class CrossSection:
    """The cross-section of a scene at one height, updated as bodies move.

    Args:
        height: Height above the world's origin [m].
    """

    def __init__(self, height: float):
        self._height = height
        self._static: Dict[str, _Outline] = {}
        self._moving: Dict[str, _Outline] = {}
        # Kinematic bodies: they are translated but not rotated, so that they are sliced only once.
        self._kinematic: Dict[str, _Outline] = {}
        self._stacked: Optional[_Stacked] = None

    def add(self, body: Body) -> None:
        """Add a body."""
        self._place(body, body.pose_in_world)

    def move(self, name: str, pose: np.ndarray) -> None:
        """Move a static body; the poses of others are read each time.

        Args:
            name: Name of the body; others than static ones are ignored.
            pose: Pose (4, 4) in the world.
        """
        if name in self._static:
            self._place(self._static[name].body, pose)

    def remove(self, name: str) -> None:
        """Remove a body."""
        for outlines in (self._static, self._moving, self._kinematic):
            outlines.pop(name, None)
        self._stacked = None

    def update(self, pose_of: Callable[[str], np.ndarray]) -> None:
        """Recompute the outlines of moving bodies at their exact present poses.

        Args:
            pose_of: Returns the present pose (4, 4) of a body.
        """
        for name, outline in list(self._moving.items()):
            self._place(outline.body, pose_of(name))

    def segments(self, pose_of: Callable[[str], np.ndarray]) -> np.ndarray:
        """Return the segments (N, 4) of all outlines as x, y, x, y [m].

        Args:
            pose_of: Returns the present pose (4, 4) of a body.
        """
        stacked = self._stack()
        if not self._moving and not self._kinematic:
            return stacked.static
        for name, outline in self._moving.items():
            pose = pose_of(name)
            if _differ(pose, outline.computed_at):
                self._place(outline.body, pose)
        moving = [outline.segments for outline in self._moving.values()]
        return np.concatenate([stacked.static, stacked.kinematic(pose_of), *moving])

    def retros(self) -> np.ndarray:
        """Return the laser_retro (N,) of the segments that ``segments`` returned last."""
        stacked = self._stack()
        if not self._moving:
            return stacked.retros
        return np.concatenate([stacked.retros, *(outline.retros for outline in self._moving.values())])

    def _stack(self) -> "_Stacked":
        if self._stacked is None:
            self._stacked = _Stacked(list(self._static.values()), list(self._kinematic.values()))
        return self._stacked

    def _place(self, body: Body, pose: np.ndarray) -> None:
        outline = _Outline(body, pose, *self._slice(body, pose))
        if body.mass is not None:
            self._moving[body.name] = outline
            return
        (self._kinematic if body.is_kinematic else self._static)[body.name] = outline
        self._stacked = None

    def _slice(self, body: Body, pose: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """Return the segments (N, 4) of a body's outlines, and the laser_retro (N,) of each."""
        outlines = [
            (outline, part.laser_retro)
            for part in body.collisions
            for outline in slice_shape(part.shape, pose @ part.pose_in_body, self._height, self._height)
        ]
        sides = [np.hstack((outline, np.roll(outline, -1, axis=0))) for outline, _ in outlines]
        retros = [np.full(len(outline), laser_retro) for outline, laser_retro in outlines]
        return np.vstack([np.empty((0, 4)), *sides]), np.concatenate([np.empty(0), *retros])


class _Stacked:
    """Segments of all static and kinematic bodies, in one array for each of the two kinds.

    Attributes:
        static: Segments (N, 4) of static bodies as x, y, x, y in the world [m].
        retros: laser_retro (N + M,) of the static and then of the kinematic segments.
    """

    def __init__(self, static: Sequence[_Outline], kinematic: Sequence[_Outline]):
        self.static = np.vstack([np.empty((0, 4)), *(outline.segments for outline in static)])
        self.retros = np.concatenate([np.empty(0), *(outline.retros for outline in (*static, *kinematic))])
        self._names = [outline.body.name for outline in kinematic]
        self._segments = np.vstack([np.empty((0, 4)), *(outline.segments for outline in kinematic)])
        self._computed_at = np.array([_ends(outline.computed_at) for outline in kinematic]).reshape(-1, 4)
        counts = np.array([len(outline.segments) for outline in kinematic], dtype=np.intp)
        # Index of the body of each segment.
        self._body_indices = np.repeat(np.arange(len(kinematic)), counts)

    def kinematic(self, pose_of: Callable[[str], np.ndarray]) -> np.ndarray:
        """Return the segments (M, 4) of kinematic bodies at their present positions."""
        if not self._names:
            return self._segments
        displacements = np.array([_ends(pose_of(name)) for name in self._names]) - self._computed_at
        return self._segments + displacements.take(self._body_indices, axis=0)


def _ends(pose: np.ndarray) -> Tuple[float, float, float, float]:
    """Return x, y, x, y of a pose (4, 4), for both ends of a segment."""
    x, y = pose.item(0, 3), pose.item(1, 3)
    return x, y, x, y


def _differ(pose: np.ndarray, before: np.ndarray) -> bool:
    """Return whether two poses (4, 4) differ; compares positions first, as most moving bodies translate."""
    position, position_before = pose[:2, 3].tolist(), before[:2, 3].tolist()
    has_moved = any(abs(a - b) > POSE_TOLERANCE for a, b in zip(position, position_before))
    return has_moved or bool(np.abs(pose - before).max() > POSE_TOLERANCE)


def cast_beams(
    segments: np.ndarray, x: float, y: float, first: float, increment: float, count: int, max_range: float
) -> Tuple[np.ndarray, np.ndarray]:
    """Cast beams at segments.

    Args:
        segments: Segments (N, 4) as x, y, x, y [m].
        x: Position of the sensor [m].
        y: Position of the sensor [m].
        first: Direction of the first beam [rad].
        increment: Angle between two beams [rad], positive.
        count: Number of beams.
        max_range: Largest range [m].

    Returns:
        The distance (count,) to the nearest segment along each beam, infinite if there is none within
        ``max_range``, and the index (count,) of that segment, else -1.
    """
    from sim_bridge.views.kernels import cast_rays  # late: it brings numba

    return cast_rays(np.ascontiguousarray(segments), x, y, first, increment, count, max_range)


def warm_up() -> None:
    """Compile the ray casting kernel, or load it from the cache, before the first scan needs it."""
    cast_beams(np.empty((0, 4)), 0.0, 0.0, 0.0, 1.0, 1, 1.0)
