"""What layers draw: few kinds of things, as arrays, which the page knows how to show."""

from dataclasses import dataclass, field
from typing import Optional, Tuple, Union

import numpy as np

Colour = Tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Points:
    """``points``: (N, 3) metres; ``colours``: (N, 3) uint8, or one for all; ``size``: metres across."""

    points: np.ndarray
    colours: Union[np.ndarray, Colour]
    size: float = 0.04


@dataclass(frozen=True, eq=False)
class Lines:
    """``segments``: (N, 2, 3) metres; ``colours``: (N, 2, 3) uint8, or one for all; ``width``: pixels."""

    segments: np.ndarray
    colours: Union[np.ndarray, Colour]
    width: float = 3.0


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles: ``vertices`` (N, 3) metres, ``triangles`` (M, 3); ``opacity``: 0 to 1."""

    vertices: np.ndarray
    triangles: np.ndarray
    colour: Colour
    opacity: float = 1.0
    is_smooth: bool = False


@dataclass(frozen=True, eq=False)
class Floor:
    """A picture (rows, columns, 4) uint8, first row at the top, that lies flat: ``width`` along x, m.

    ``height``: along y; ``pose``: (4, 4) of its lower left corner.
    """

    picture: np.ndarray
    width: float
    height: float
    pose: np.ndarray


@dataclass(frozen=True, eq=False)
class Label:
    text: str
    position: np.ndarray


@dataclass(frozen=True, eq=False)
class Axes:
    """Frames: ``poses`` (N, 4, 4); ``length``: of their axes, metres."""

    poses: np.ndarray
    length: float = 0.3


@dataclass(frozen=True, eq=False)
class Screen:
    """A camera's picture (rows, columns, 3) uint8, which is shown beside the world."""

    picture: np.ndarray


Drawable = Union[Points, Lines, Surface, Floor, Label, Axes, Screen]


@dataclass(frozen=True, eq=False)
class Part:
    """A thing seen from ``frame``; ``name`` tells it from the others of its layer; the same name replaces.

    ``pose``: (4, 4) in that frame; ``seconds``: after which it vanishes by itself; ``stamp``: seconds of ROS
    time, when it was seen from where the frame was then; None: it goes along with its frame.
    """

    name: str
    frame: str
    thing: Drawable
    pose: Optional[np.ndarray] = None
    seconds: float = np.inf
    stamp: Optional[float] = None


@dataclass(frozen=True, eq=False)
class Drawing:
    """What a layer shows from now on; ``keeps``: parts that are not named stay as they are.

    ``gone``: names of parts that are shown no more, or "*" for all that were shown before. ``told``: what
    cannot be drawn, in words.
    """

    parts: Tuple[Part, ...] = ()
    keeps: bool = False
    gone: Tuple[str, ...] = ()
    told: str = field(default="")
