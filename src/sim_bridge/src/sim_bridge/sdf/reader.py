"""Reads worlds and models from SDF."""

from pathlib import Path
from typing import Iterator, List, Optional, Sequence, Tuple, cast

import numpy as np

from sim_bridge.geometry.meshes import load_mesh
from sim_bridge.geometry.pose3 import inverse
from sim_bridge.geometry.shapes import MeshFile, Plane, Shape, VisualShape, scaled
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.sdf.actors import read_actor
from sim_bridge.sdf.element import Element, parse, parse_text
from sim_bridge.sdf.frames import SdfFrames
from sim_bridge.sdf.inertia import read_inertia, read_mass
from sim_bridge.sdf.joints import read_joint, with_start_position, without_loops
from sim_bridge.sdf.lights import read_lights
from sim_bridge.sdf.models import ModelReader, SdfModel, declare_frames
from sim_bridge.sdf.shapes.colours import read_colour, read_emissive
from sim_bridge.sdf.shapes.geometry import MissingMeshError, UnsupportedGeometryError, read_shape
from sim_bridge.sdf.state import ModelState, read_states
from sim_bridge.sdf.warnings import SkippedElements
from sim_bridge.world import (
    Body,
    Collision,
    DrivenModel,
    Inertia,
    Joint,
    Light,
    SurfaceProperties,
    Visual,
    World,
)

DEFAULT_GRAVITY = 9.8
# Folder of the models that are part of sim_bridge; those of other folders take precedence.
MODELS = Path(__file__).resolve().parents[1] / "models"


def load_world(path, model_folders: Sequence[Path] = (), strict: bool = False) -> World:
    """Load the world of an SDF file.

    Args:
        path: The file.
        model_folders: Folders that are searched for ``model://`` URIs (GAZEBO_MODEL_PATH).
        strict: Treat a missing mesh or model as an error; otherwise it is ignored with a warning in
            ``World.warnings``, like all content that is not supported.

    Raises:
        WorldError: The file cannot be read or holds a value that is not valid.
    """
    path = Path(path)
    world = parse(path).required("world")
    reader = _SdfReader(tuple(Path(folder) for folder in model_folders), SkippedElements(strict))
    reader.read_world(world, path.parent)
    return reader.world(world.name, _gravity(world))


def read_model(
    xml, name: str, pose: np.ndarray, model_folders: Sequence[Path] = (), strict: bool = False
) -> World:
    """Return a world with the one model of an SDF text.

    Args:
        xml: The text: a model, or a world that includes one.
        name: Name of the model.
        pose: Pose (4, 4) in the world.
        model_folders: Folders that are searched for ``model://`` URIs.
        strict: Treat a missing mesh or model as an error.

    Raises:
        WorldError: The text cannot be read or holds a value that is not valid.
    """
    reader = _SdfReader(tuple(model_folders), SkippedElements(strict))
    root = parse_text(xml, name)
    include = root.child("world", "include")
    if include is not None:
        reader.read_include(include, name, pose)
    else:
        reader.read_model(root.required("model"), name, pose)
    return reader.world(name)


class _SdfReader:
    """Collects bodies, joints, robots, lights, trajectories and warnings."""

    def __init__(self, model_folders: Tuple[Path, ...], warnings: SkippedElements):
        self._bodies: List[Body] = []
        self._joints: List[Joint] = []
        self._robots: List[DrivenModel] = []
        self._lights: List[Light] = []
        self._trajectories: List[ScriptedTrajectory] = []
        self._model_folders = model_folders = (*model_folders, MODELS)
        self._warnings = warnings
        self._models = ModelReader(model_folders, warnings)

    def world(self, name: str, gravity: float = DEFAULT_GRAVITY) -> World:
        """Return a world of all that has been read."""
        return World(
            name,
            tuple(self._bodies),
            gravity,
            tuple(self._warnings.lines()),
            tuple(self._joints),
            tuple(self._robots),
            tuple(self._lights),
            tuple(self._trajectories),
        )

    def read_world(self, world: Element, folder: Path) -> None:
        """Read a <world>."""
        self._warnings.check_children(world)
        for physics in world.children("physics"):
            self._warnings.check_children(physics)
        self._lights.extend(read_lights(world))
        states = list(world.children("state"))
        insertions = [inserted for state in states for inserted in state.children("insertions")]
        deleted = [
            name.text for state in states for part in state.children("deletions") for name in part.children()
        ]
        overrides = read_states(states)
        parts = [world, *insertions]
        models = [model for part in parts for model in self._models.models_in(part, folder)]
        frames = SdfFrames({model.name: model.frames for model in models}.get)
        declare_frames(frames, world)
        for model in models:
            frames.declare(model.name, model.placed_by, inside=model.placement())
        for model in models:
            if model.name not in deleted:
                self._add_model(model, frames.frame(model.name, model.element), overrides.get(model.name))
        for actor in world.children("actor"):
            body, trajectory = read_actor(actor, self._warnings)
            self._bodies.append(body)
            self._trajectories += [trajectory] if trajectory else []

    def read_model(self, element: Element, name: str, pose: np.ndarray) -> None:
        self._add_model(self._models.model(element, element, Path(), name), pose, None)

    def read_include(self, include: Element, name: str, pose: np.ndarray) -> None:
        model = self._models.included(include, Path())
        if model is not None:
            model.name = name
            self._add_model(model, pose, None)

    def _add_model(self, model: SdfModel, in_world: np.ndarray, state: Optional[ModelState]) -> None:
        """Add a model; one with a drive plugin is added as a robot."""
        bodies, joints = len(self._bodies), len(self._joints)
        self._add_links(model, in_world, state)
        if model.is_driven:
            robot = DrivenModel(
                model.name, model.element, tuple(self._bodies[bodies:]), tuple(self._joints[joints:])
            )
            self._robots.append(robot)
            del self._bodies[bodies:], self._joints[joints:]

    def _add_links(
        self,
        model: SdfModel,
        in_world: np.ndarray,
        state: Optional[ModelState],
        scope: str = "",
        outermost: Optional[np.ndarray] = None,
    ) -> None:
        """Add the links and joints of a model and of its nested models.

        Args:
            model: The model.
            in_world: Pose (4, 4) of the model.
            state: Saved state that overrides its poses.
            scope: Prefix of its full name.
            outermost: Pose (4, 4) of the outermost model that it is nested in, if any.
        """
        state = state or ModelState()
        in_world = in_world if state.pose is None else state.pose
        outermost = in_world if outermost is None else outermost
        full_name = scope + model.name
        for link in model.element.children("link"):
            pose = state.links.get(link.name, in_world @ model.frames.frame(link.name, link))
            self._bodies.append(self._body(link, model, f"{full_name}::{link.name}", pose, outermost, state))
        for nested in model.nested:
            pose = in_world @ model.frames.frame(nested.name, nested.element)
            self._add_links(nested, pose, state.models.get(nested.name), full_name + "::", outermost)
        if not model.is_static:
            self._add_joints(model, full_name)

    def _add_joints(self, model: SdfModel, name: str) -> None:
        links = dict(_links_of(model))
        elements = {joint.name: joint for joint in model.element.children("joint")}
        joints = [read_joint(joint, model, name, links, self._warnings) for joint in elements.values()]

        def warn(joint: Joint) -> None:
            self._warnings.skip(elements[joint.name[len(name) + 2 :]], "closes a loop, ignored")

        placed = {body.name: body.pose_in_world for body in self._bodies}
        in_model = {f"{name}::{link}": pose for link, pose in links.items()}
        for joint in without_loops(joints, warn):
            if joint.kind != "fixed" and joint.parent:
                before, now = (
                    inverse(poses[joint.parent]) @ poses[joint.child] for poses in (in_model, placed)
                )
                joint = with_start_position(joint, before, now)
            self._joints.append(joint)

    def _body(
        self,
        link: Element,
        model: SdfModel,
        name: str,
        in_world: np.ndarray,
        outermost: np.ndarray,
        state: ModelState,
    ) -> Body:
        if not model.is_driven:
            self._warnings.check_children(link)
        in_model = model.frames.frame(link.name, link)
        collisions = tuple(self._collisions(link, model, in_model, state))
        visuals = tuple(self._visuals(link, model, in_model, state))
        fixed = model.is_static or link.flag("kinematic")
        fixed = fixed or any(isinstance(part.shape, Plane) for part in collisions)
        gravity = link.child("gravity")
        return Body(
            name,
            in_world,
            collisions,
            None if fixed else read_mass(link),
            self._surface(link),
            inverse(outermost) @ in_world,
            visuals,
            Inertia() if fixed else read_inertia(link, self._warnings),
            _damping(link),
            gravity is None or link.flag("gravity"),
            is_dock=model.is_dock and fixed,
        )

    def _collisions(
        self, link: Element, model: SdfModel, in_model: np.ndarray, state: ModelState
    ) -> Iterator[Collision]:
        for part in link.children("collision"):
            self._warnings.check_children(part)
            shape = self._collision_shape(part, model, state)
            if shape is not None:
                laser_retro = part.number("laser_retro", default=0.0)
                yield Collision(shape, _pose_in_link(part, link, model, in_model), laser_retro, part.name)

    def _visuals(
        self, link: Element, model: SdfModel, in_model: np.ndarray, state: ModelState
    ) -> Iterator[Visual]:
        for part in link.children("visual"):
            self._warnings.check_children(part)
            shape = self._visual_shape(part, model, state)
            if shape is not None:
                placed = _pose_in_link(part, link, model, in_model)
                yield Visual(shape, placed, read_colour(part), read_emissive(part))

    def _visual_shape(self, part: Element, model: SdfModel, state: ModelState) -> Optional[VisualShape]:
        try:
            shape = read_shape(part.required("geometry"), model.folder, self._model_folders)
        except MissingMeshError as missing:
            shape = missing.fallback
            self._warnings.missing(
                part, str(missing), "ignored" if shape is None else "only its footprint is used"
            )
        except UnsupportedGeometryError as error:
            self._warnings.skip(part, f"{error}, ignored", kind=("geometry", str(error)))
            return None
        x, y, z = state.scale
        return None if shape is None else scaled(shape, (x, y, z))

    def _collision_shape(self, part: Element, model: SdfModel, state: ModelState) -> Optional[Shape]:
        shape = self._visual_shape(part, model, state)
        return load_mesh(shape) if isinstance(shape, MeshFile) else cast(Optional[Shape], shape)

    def _surface(self, link: Element) -> SurfaceProperties:
        """Return the surface of a link's first collision; friction is clipped to 1 (many worlds have 100)."""
        surface = link.child("collision", "surface")
        if surface is None:
            return SurfaceProperties()
        self._warnings.check_children(surface)
        mu = surface.number("friction", "ode", "mu", default=1.0)
        bounce = surface.number("bounce", "restitution_coefficient", default=0.0)
        return SurfaceProperties(min(max(mu, 0.0), 1.0), min(max(bounce, 0.0), 1.0))


def _links_of(model: SdfModel, scope: str = "") -> List[Tuple[str, np.ndarray]]:
    """Return the names and the poses (4, 4) in a model of its links and of those of nested models."""
    links = [
        (scope + link.name, model.frames.frame(link.name, link)) for link in model.element.children("link")
    ]
    for nested in model.nested:
        nested_pose = model.frames.frame(nested.name, nested.element)
        links += [(scope + name, nested_pose @ pose) for name, pose in _links_of(nested, f"{nested.name}::")]
    return links


def _pose_in_link(part: Element, link: Element, model: SdfModel, link_in_model: np.ndarray) -> np.ndarray:
    return inverse(link_in_model) @ model.frames.pose_of(part, link.name)


def _damping(link: Element) -> Tuple[float, float]:
    return (
        link.number("velocity_decay", "linear", default=0.0),
        link.number("velocity_decay", "angular", default=0.0),
    )


def _gravity(world: Element) -> float:
    gravity = world.child("gravity") or world.child("physics", "gravity")
    return -gravity.numbers(3)[2] if gravity is not None else DEFAULT_GRAVITY
