"""What a simulated world consists of."""

from dataclasses import dataclass, field
from typing import Optional, Tuple

import numpy as np

from sim_bridge.pose3 import IDENTITY
from sim_bridge.shapes import Shape


@dataclass(frozen=True, eq=False)
class Collision:
    """A solid part of a body, ``pose_in_body``: (4, 4)."""

    shape: Shape
    pose_in_body: np.ndarray


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid thing; ``name`` is ``model::link``, ``pose_in_world``: (4, 4).

    ``pose_in_model``: (4, 4), of the link in the frame of the outermost model that it belongs to. ``mass`` in
    kg, None if it never moves. ``friction``: Coulomb's coefficient.
    """

    name: str
    pose_in_world: np.ndarray
    collisions: Tuple[Collision, ...]
    mass: Optional[float] = None
    friction: float = 1.0
    pose_in_model: np.ndarray = field(default_factory=lambda: IDENTITY)

    @property
    def model(self) -> str:
        return self.name.split("::", 1)[0]


@dataclass(frozen=True)
class World:
    """Bodies, and in words what the world's file holds that was left out."""

    name: str
    bodies: Tuple[Body, ...]
    gravity: float = 9.8
    warnings: Tuple[str, ...] = ()
