"""The outlines of a world's bodies at one height, and beams cast at them."""

from dataclasses import dataclass
from typing import Callable, Dict, Optional, Sequence, Tuple

import numpy as np

from sim_bridge.geometry.slicing import slice_shape
from sim_bridge.world import Body

# Metres or radians of movement below which an outline is not drawn anew: bodies at rest tremble, and meshes
# take their time.
STILL = 5e-4


@dataclass(frozen=True, eq=False)
class _Outline:
    """The sides (N, 4) of a body's cut, and how brightly they reflect (N,), drawn with it at ``drawn_at``."""

    body: Body
    drawn_at: np.ndarray
    segments: np.ndarray
    retros: np.ndarray


class CrossSection:
    """A level cut through the bodies of a world that follows those that move."""

    def __init__(self, height: float):
        self._height = height
        self._still: Dict[str, _Outline] = {}
        self._moving: Dict[str, _Outline] = {}
        # What is on a course, where it was at first: it is shifted and not turned, so it is cut but once.
        self._shifted: Dict[str, _Outline] = {}
        self._stacked: Optional[_Stacked] = None

    def add(self, body: Body) -> None:
        self._place(body, body.pose_in_world)

    def move(self, name: str, pose: np.ndarray) -> None:
        """A body that otherwise keeps still has been put to another place."""
        if name in self._still:
            self._place(self._still[name].body, pose)

    def remove(self, name: str) -> None:
        for outlines in (self._still, self._moving, self._shifted):
            outlines.pop(name, None)
        self._stacked = None

    def update(self, pose_of: Callable[[str], np.ndarray]) -> None:
        """Draws what moves where it now is, to the last bit."""
        for name, outline in list(self._moving.items()):
            self._place(outline.body, pose_of(name))

    def segments(self, pose_of: Callable[[str], np.ndarray]) -> np.ndarray:
        """Sides (N, 4) of all outlines as x, y, x, y; ``pose_of`` says where a body is now, (4, 4)."""
        stacked = self._stack()
        if not self._moving and not self._shifted:
            return stacked.still
        for name, outline in self._moving.items():
            pose = pose_of(name)
            if _differ(pose, outline.drawn_at):
                self._place(outline.body, pose)
        moving = [outline.segments for outline in self._moving.values()]
        return np.concatenate([stacked.still, stacked.shifted(pose_of), *moving])

    def retros(self) -> np.ndarray:
        """How brightly each of the sides last told by ``segments`` reflects a laser, (N,)."""
        stacked = self._stack()
        if not self._moving:
            return stacked.retros
        return np.concatenate([stacked.retros, *(outline.retros for outline in self._moving.values())])

    def _stack(self) -> "_Stacked":
        if self._stacked is None:
            self._stacked = _Stacked(list(self._still.values()), list(self._shifted.values()))
        return self._stacked

    def _place(self, body: Body, pose: np.ndarray) -> None:
        outline = _Outline(body, pose, *self._cut(body, pose))
        if body.mass is not None:
            self._moving[body.name] = outline
            return
        (self._shifted if body.is_kinematic else self._still)[body.name] = outline
        self._stacked = None

    def _cut(self, body: Body, pose: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """Sides (N, 4) of a body's outlines, and how brightly each reflects, (N,)."""
        cuts = [
            (outline, part.laser_retro)
            for part in body.collisions
            for outline in slice_shape(part.shape, pose @ part.pose_in_body, self._height, self._height)
        ]
        sides = [np.hstack((outline, np.roll(outline, -1, axis=0))) for outline, _ in cuts]
        retros = [np.full(len(outline), laser_retro) for outline, laser_retro in cuts]
        return np.vstack([np.empty((0, 4)), *sides]), np.concatenate([np.empty(0), *retros])


class _Stacked:
    """The sides (N, 4) of what keeps ``still``, and of what is shifted; ``retros`` (N + M,) of both."""

    def __init__(self, still: Sequence[_Outline], shifted: Sequence[_Outline]):
        self.still = np.vstack([np.empty((0, 4)), *(outline.segments for outline in still)])
        self.retros = np.concatenate([np.empty(0), *(outline.retros for outline in (*still, *shifted))])
        self._names = [outline.body.name for outline in shifted]
        self._drawn = np.vstack([np.empty((0, 4)), *(outline.segments for outline in shifted)])
        self._drawn_at = np.array([_ends(outline.drawn_at) for outline in shifted]).reshape(-1, 4)
        counts = np.array([len(outline.segments) for outline in shifted], dtype=np.intp)
        # Whose each side is.
        self._whose = np.repeat(np.arange(len(shifted)), counts)

    def shifted(self, pose_of: Callable[[str], np.ndarray]) -> np.ndarray:
        """Sides (M, 4) of what is shifted, where it is now."""
        if not self._names:
            return self._drawn
        ways = np.array([_ends(pose_of(name)) for name in self._names]) - self._drawn_at
        return self._drawn + ways.take(self._whose, axis=0)


def _ends(pose: np.ndarray) -> Tuple[float, float, float, float]:
    """The place of a pose (4, 4), for both ends of a side."""
    x, y = pose.item(0, 3), pose.item(1, 3)
    return x, y, x, y


def _differ(pose: np.ndarray, before: np.ndarray) -> bool:
    """Whether a pose (4, 4) is another than before; first the place, as most that moves goes somewhere."""
    place, place_before = pose[:2, 3].tolist(), before[:2, 3].tolist()
    has_gone = any(abs(here - there) > STILL for here, there in zip(place, place_before))
    return has_gone or bool(np.abs(pose - before).max() > STILL)


def cast_beams(
    segments: np.ndarray, x: float, y: float, first: float, increment: float, count: int, sight: float
) -> Tuple[np.ndarray, np.ndarray]:
    """Distance, metres, from (x, y) to the nearest segment along each of ``count`` beams, and which that is.

    ``segments``: (N, 4) as x, y, x, y. Beam i points along ``first + i * increment``, radians, increment
    positive. Returns (count,) infinite and (count,) -1 where nothing lies within ``sight`` metres.
    """
    from sim_bridge.views.kernels import cast_rays  # late: it brings numba

    return cast_rays(np.ascontiguousarray(segments), x, y, first, increment, count, sight)


def warm_up() -> None:
    """Compiles, or loads from the cache, what the first scan would wait for."""
    cast_beams(np.empty((0, 4)), 0.0, 0.0, 0.0, 1.0, 1, 1.0)
