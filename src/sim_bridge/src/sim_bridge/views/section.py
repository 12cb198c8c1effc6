"""The outlines of a world's bodies at one height, and beams cast at them."""

from dataclasses import dataclass
from typing import Callable, Dict, Optional, Tuple

import numpy as np

from sim_bridge.geometry.slicing import cut
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


class Section:
    """A level cut through the bodies of a world that follows those that move."""

    def __init__(self, height: float):
        self._height = height
        self._still: Dict[str, _Outline] = {}
        self._moving: Dict[str, _Outline] = {}
        # Of what is on a course, where it began: it is shifted and not turned, so it need not be cut again.
        self._begun: Dict[str, _Outline] = {}
        self._still_segments: Optional[np.ndarray] = None
        self._still_retros = np.empty(0)

    def add(self, body: Body) -> None:
        self._place(body, body.pose_in_world)

    def move(self, name: str, pose: np.ndarray) -> None:
        """A body that otherwise keeps still has been put to another place."""
        if name in self._still:
            self._place(self._still[name].body, pose)

    def remove(self, name: str) -> None:
        self._moving.pop(name, None)
        if self._still.pop(name, None) is not None:
            self._still_segments = None

    def redraw(self, pose_of: Callable[[str], np.ndarray]) -> None:
        """Draws what moves where it now is, to the last bit."""
        for name, outline in list(self._moving.items()):
            self._place(outline.body, pose_of(name))

    def segments(self, pose_of: Callable[[str], np.ndarray]) -> np.ndarray:
        """Sides (N, 4) of all outlines as x, y, x, y; ``pose_of`` says where a body is now, (4, 4)."""
        if self._still_segments is None:
            sides = [outline.segments for outline in self._still.values()]
            self._still_segments = np.vstack([np.empty((0, 4)), *sides])
            retros = [outline.retros for outline in self._still.values()]
            self._still_retros = np.concatenate([np.empty(0), *retros])
        if not self._moving:
            return self._still_segments
        for name, outline in self._moving.items():
            pose = pose_of(name)
            if _differ(pose, outline.drawn_at):
                self._place(outline.body, pose)
        return np.concatenate(
            [self._still_segments, *(outline.segments for outline in self._moving.values())]
        )

    def retros(self) -> np.ndarray:
        """How brightly each of the sides last told by ``segments`` reflects a laser, (N,)."""
        if not self._moving:
            return self._still_retros
        return np.concatenate([self._still_retros, *(outline.retros for outline in self._moving.values())])

    def _place(self, body: Body, pose: np.ndarray) -> None:
        if body.is_on_course:
            outline = self._shifted(body, pose)
        else:
            outline = _Outline(body, pose, *self._cut(body, pose))
        if body.keeps_still:
            self._still[body.name] = outline
            self._still_segments = None
        else:
            self._moving[body.name] = outline

    def _shifted(self, body: Body, pose: np.ndarray) -> _Outline:
        begun = self._begun.get(body.name)
        if begun is None or begun.body is not body:
            begun = _Outline(body, body.pose_in_world, *self._cut(body, body.pose_in_world))
            self._begun[body.name] = begun
        way = pose[:2, 3] - begun.drawn_at[:2, 3]
        return _Outline(body, pose, begun.segments + np.concatenate((way, way)), begun.retros)

    def _cut(self, body: Body, pose: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """Sides (N, 4) of a body's outlines, and how brightly each reflects, (N,)."""
        cuts = [
            (outline, part.retro)
            for part in body.collisions
            for outline in cut(part.shape, pose @ part.pose_in_body, self._height, self._height)
        ]
        sides = [np.hstack((outline, np.roll(outline, -1, axis=0))) for outline, _ in cuts]
        retros = [np.full(len(outline), retro) for outline, retro in cuts]
        return np.vstack([np.empty((0, 4)), *sides]), np.concatenate([np.empty(0), *retros])


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
    from sim_bridge.views.kernels import cast  # late: it brings numba

    return cast(np.ascontiguousarray(segments), x, y, first, increment, count, sight)


def warm_up() -> None:
    """Compiles, or loads from the cache, what the first scan would wait for."""
    cast_beams(np.empty((0, 4)), 0.0, 0.0, 0.0, 1.0, 1, 1.0)
