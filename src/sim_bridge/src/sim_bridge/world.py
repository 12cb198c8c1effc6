"""What a simulated world consists of."""

from dataclasses import dataclass, field
from typing import Any, Optional, Tuple

import numpy as np

from sim_bridge.doorway import Door
from sim_bridge.geometry.pose3 import IDENTITY
from sim_bridge.geometry.shapes import Shape, VisualShape
from sim_bridge.people.walker import Walker
from sim_bridge.scripted_trajectories import ScriptedTrajectory

Colour = Tuple[float, float, float]
DARK: Colour = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Collision:
    """A solid part of a body, ``pose_in_body``: (4, 4); ``retro``: how brightly it reflects a laser."""

    shape: Shape
    pose_in_body: np.ndarray
    laser_retro: float = 0.0
    name: str = ""


@dataclass(frozen=True, eq=False)
class Visual:
    """What a camera sees of a body, ``pose_in_body``: (4, 4); no ``colour`` (0 to 1): that of the mesh.

    ``glow``: what it shows of itself, without any light.
    """

    shape: VisualShape
    pose_in_body: np.ndarray
    colour: Optional[Colour] = None
    emissive: Colour = DARK


@dataclass(frozen=True, eq=False)
class Inertia:
    """``pose_in_body``: (4, 4), of the centre of mass and the principal axes; ``moments``: (3,), kg m^2.

    Without ``moments`` they follow from the shapes.
    """

    pose_in_body: np.ndarray = field(default_factory=lambda: IDENTITY)
    moments: Optional[np.ndarray] = None


@dataclass(frozen=True)
class SurfaceProperties:
    """Coulomb's coefficient of ``friction``, and of ``restitution``: how much a thing bounces."""

    friction: float = 1.0
    restitution: float = 0.0


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid thing; ``name`` is ``model::link``, ``pose_in_world``: (4, 4).

    One without mass that ``is_on_course`` goes its own way.
    ``pose_in_model``: (4, 4), of the link in the frame of the outermost model that it belongs to. ``mass`` in
    kg, None if it never moves. ``damping``: of its linear and angular velocity, 1/s. Without
    weight it is not drawn down.
    """

    name: str
    pose_in_world: np.ndarray
    collisions: Tuple[Collision, ...]
    mass: Optional[float] = None
    surface: SurfaceProperties = SurfaceProperties()
    pose_in_model: np.ndarray = field(default_factory=lambda: IDENTITY)
    visuals: Tuple[Visual, ...] = ()
    inertia: Inertia = field(default_factory=Inertia)
    damping: Tuple[float, float] = (0.0, 0.0)
    has_gravity: bool = True
    is_kinematic: bool = False

    @property
    def model(self) -> str:
        return self.name.split("::", 1)[0]

    @property
    def is_static(self) -> bool:
        """Whether it stays where it is unless it is put elsewhere."""
        return self.mass is None and not self.is_kinematic


@dataclass(frozen=True, eq=False)
class Joint:
    """Holds the body ``child`` to the body ``parent``, or to the world if that is empty.

    ``kind``: fixed, revolute or prismatic. ``pose_in_child``: (4, 4); ``axis``: (3,), of length 1, in the
    joint's frame. Limits and ``start``, the position that it starts at, in rad or m; ``effort``: N m or N
    that may be applied; ``friction``: N m or N; ``damping``: N m s/rad or N s/m.
    """

    name: str
    kind: str
    parent: str
    child: str
    pose_in_child: np.ndarray
    axis: np.ndarray
    lower: float = -np.inf
    upper: float = np.inf
    effort: float = np.inf
    damping: float = 0.0
    friction: float = 0.0
    start: float = 0.0

    @property
    def model(self) -> str:
        return self.name.split("::", 1)[0]


@dataclass(frozen=True, eq=False)
class DrivenModel:
    """A model with a plugin that drives it: a robot, to be read from its ``element`` of SDF."""

    name: str
    element: Any
    bodies: Tuple[Body, ...]
    joints: Tuple[Joint, ...]


@dataclass(frozen=True)
class Light:
    """``diffuse``: red, green, blue, alpha, 0 to 1; ``attenuation``: constant, linear, quadratic."""

    name: str
    diffuse: Tuple[float, float, float, float]
    attenuation: Tuple[float, float, float]


@dataclass(frozen=True)
class World:
    """Bodies, joints between them, robots, courses, people, doors, and in words what its file holds that was
    left out. ``bodies`` are without those of people and doors.
    """

    name: str
    bodies: Tuple[Body, ...]
    gravity: float = 9.8
    warnings: Tuple[str, ...] = ()
    joints: Tuple[Joint, ...] = ()
    robots: Tuple[DrivenModel, ...] = ()
    lights: Tuple[Light, ...] = ()
    trajectories: Tuple[ScriptedTrajectory, ...] = ()
    walkers: Tuple[Walker, ...] = ()
    doors: Tuple[Door, ...] = ()
