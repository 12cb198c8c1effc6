"""The description of a simulated world: bodies, joints, lights, robots and dynamic obstacles."""

from dataclasses import dataclass, field
from typing import Any, Optional, Tuple

import numpy as np

from sim_bridge.doorway import Door
from sim_bridge.geometry.pose3 import IDENTITY
from sim_bridge.geometry.shapes import Shape, VisualShape
from sim_bridge.people.walker import Walker
from sim_bridge.scripted_trajectories import ModelMove, ScriptedTrajectory

Colour = Tuple[float, float, float]
DARK: Colour = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Collision:
    """A solid part of a body (SDF <collision>).

    Attributes:
        shape: The shape, in its own frame.
        pose_in_body: Pose (4, 4) of the shape in the body frame.
        laser_retro: Intensity with which it reflects a laser (SDF <laser_retro>).
        name: Name of the collision.
    """

    shape: Shape
    pose_in_body: np.ndarray
    laser_retro: float = 0.0
    name: str = ""


@dataclass(frozen=True, eq=False)
class Visual:
    """A visible part of a body (SDF <visual>).

    Attributes:
        shape: The shape.
        pose_in_body: Pose (4, 4) of the shape in the body frame.
        colour: Diffuse red, green, blue, 0 to 1; None for the colours of the mesh.
        emissive: Colour that is shown without any light.
    """

    shape: VisualShape
    pose_in_body: np.ndarray
    colour: Optional[Colour] = None
    emissive: Colour = DARK


@dataclass(frozen=True, eq=False)
class Inertia:
    """Mass distribution of a body (SDF <inertial>).

    Attributes:
        pose_in_body: Pose (4, 4) of the centre of mass and the principal axes in the body frame.
        moments: Principal moments of inertia (3,) [kg m^2]; None to compute them from the shapes.
    """

    pose_in_body: np.ndarray = field(default_factory=lambda: IDENTITY)
    moments: Optional[np.ndarray] = None


@dataclass(frozen=True)
class SurfaceProperties:
    """Contact properties of a body (SDF <surface>).

    Attributes:
        friction: Coefficient of Coulomb friction.
        restitution: Coefficient of restitution: 0 is inelastic, 1 elastic.
        bounce_threshold: Impact speed below which it does not bounce [m/s]; None for that of the engine.
    """

    friction: float = 1.0
    restitution: float = 0.0
    bounce_threshold: Optional[float] = None


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body, or link.

    Attributes:
        name: ``model::link``.
        pose_in_world: Pose (4, 4) at the start.
        collisions: Solid parts.
        mass: Mass [kg]; None if physics does not move the body.
        surface: Contact properties.
        pose_in_model: Pose (4, 4) of the link in the frame of the outermost model that it belongs to.
        visuals: Visible parts; without any, the collisions are shown.
        inertia: Centre of mass and moments.
        damping: Damping of the linear and angular velocity [1/s].
        has_gravity: Whether gravity acts on the body.
        is_kinematic: Whether a script moves the body: a trajectory, a pedestrian or a door.
        is_dock: Whether it is a dock that charges a Kobuki (see sim_bridge.docks).
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
    is_dock: bool = False

    @property
    def model(self) -> str:
        """Name of the outermost model."""
        return self.name.split("::", 1)[0]

    @property
    def is_static(self) -> bool:
        """Whether neither physics nor a script moves the body."""
        return self.mass is None and not self.is_kinematic


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint between two bodies.

    Attributes:
        name: ``model::joint``.
        kind: ``fixed``, ``revolute`` or ``prismatic``.
        parent: Name of the parent body; empty for the world.
        child: Name of the child body.
        pose_in_child: Pose (4, 4) of the joint frame in the child's frame.
        axis: Unit vector (3,) in the joint frame.
        lower: Lower limit [rad or m].
        upper: Upper limit [rad or m].
        effort: Largest effort that may be applied [N m or N].
        damping: Viscous damping [N m s/rad or N s/m].
        friction: Static friction [N m or N].
        start: Initial position [rad or m].
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
        """Name of the outermost model."""
        return self.name.split("::", 1)[0]


@dataclass(frozen=True, eq=False)
class DrivenModel:
    """A model with a drive plugin, from which a robot is made (``read_sdf_robot``).

    Attributes:
        name: Name of the model.
        element: Its SDF <model> element.
        bodies: Its links.
        joints: Joints between the links.
    """

    name: str
    element: Any
    bodies: Tuple[Body, ...]
    joints: Tuple[Joint, ...]


@dataclass(frozen=True)
class Light:
    """A light (SDF <light>).

    Attributes:
        name: Name of the light.
        diffuse: Red, green, blue, alpha, 0 to 1.
        attenuation: Constant, linear [1/m] and quadratic [1/m^2] factors.
    """

    name: str
    diffuse: Tuple[float, float, float, float]
    attenuation: Tuple[float, float, float]


@dataclass(frozen=True)
class World:
    """A world, as read from an SDF file or built in Python.

    Attributes:
        name: Its name.
        bodies: All bodies except those of ``walkers`` and ``doors``.
        gravity: Downward acceleration [m/s^2].
        warnings: A sentence for each kind of content of the file that is ignored.
        joints: Joints between the bodies.
        robots: Models with a drive plugin.
        lights: Lights.
        trajectories: Trajectories of kinematic bodies.
        moves: Models that are moved at given times.
        walkers: Pedestrians.
        doors: Doors.
    """

    name: str
    bodies: Tuple[Body, ...]
    gravity: float = 9.8
    warnings: Tuple[str, ...] = ()
    joints: Tuple[Joint, ...] = ()
    robots: Tuple[DrivenModel, ...] = ()
    lights: Tuple[Light, ...] = ()
    trajectories: Tuple[ScriptedTrajectory, ...] = ()
    moves: Tuple[ModelMove, ...] = ()
    walkers: Tuple[Walker, ...] = ()
    doors: Tuple[Door, ...] = ()
