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
from sim_bridge.sdf.surfaces import read_damping, read_surface
from sim_bridge.sdf.warnings import NO_EFFECT, SkippedElements
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
# Default step of Gazebo's physics [s].
GAZEBO_STEP = 0.001
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
    root = parse(path)
    world = root.required("world")
    reader = _SdfReader(root, tuple(Path(folder) for folder in model_folders), SkippedElements(strict))
    reader.read_world(world, path.parent)
    return reader.world(world.name)


def read_model(
    xml, name: str, pose: np.ndarray, model_folders: Sequence[Path] = (), strict: bool = False
) -> World:
    """Return a world with the one model of an SDF text.

    Args:
        xml: The text: a model, or a world that includes one.
        name: Name of the model.
        pose: Pose (4, 4) in the world of the frame in which the text places the model.
        model_folders: Folders that are searched for ``model://`` URIs.
        strict: Treat a missing mesh or model as an error.

    Raises:
        WorldError: The text cannot be read or holds a value that is not valid.
    """
    root = parse_text(xml, name)
    reader = _SdfReader(root, tuple(model_folders), SkippedElements(strict))
    include = root.child("world", "include")
    if include is not None:
        reader.read_include(include, name, pose)
    else:
        reader.read_model(root.required("model"), name, pose)
    return reader.world(name)


class _SdfReader:
    """Collects bodies, joints, robots, lights, trajectories and warnings."""

    def __init__(self, root: Element, model_folders: Tuple[Path, ...], warnings: SkippedElements):
        self._root = root
        self._gravity_z, self._step = -DEFAULT_GRAVITY, GAZEBO_STEP
        self._bodies: List[Body] = []
        self._joints: List[Joint] = []
        self._robots: List[DrivenModel] = []
        self._lights: List[Light] = []
        self._trajectories: List[ScriptedTrajectory] = []
        self._model_folders = model_folders = (*model_folders, MODELS)
        self._warnings = warnings
        self._models = ModelReader(model_folders, warnings)

    def world(self, name: str) -> World:
        """Return a world of all that has been read."""
        for root in [self._root, *self._models.roots]:
            self._warnings.add_unread(root, [robot.element for robot in self._robots])
        return World(
            name,
            tuple(self._bodies),
            -self._gravity_z,
            tuple(self._warnings.lines()),
            tuple(self._joints),
            tuple(self._robots),
            tuple(self._lights),
            tuple(self._trajectories),
        )

    def read_world(self, world: Element, folder: Path) -> None:
        """Read a <world>."""
        self._gravity_z, self._step = _physics(world, self._warnings)
        self._lights.extend(read_lights(world))
        states = list(world.children("state"))
        insertions = [inserted for state in states for inserted in state.children("insertions")]
        deletions = [part for state in states for part in state.children("deletions")]
        deleted = [name.text for part in deletions for name in part.children()]
        for part in deletions:
            part.mark_all()
        overrides = read_states(states)
        parts = [world, *insertions]
        models = [model for part in parts for model in self._models.models_in(part, folder)]
        frames = SdfFrames({model.name: model.frames for model in models}.get)
        declare_frames(frames, world)
        for model in models:
            frames.declare(model.name, model.placed_by, inside=model.placement())
        for model in models:
            if model.name in deleted:
                model.element.mark_all()
            else:
                self._add_model(model, frames.frame(model.name, model.element), overrides.get(model.name))
        for actor in world.children("actor"):
            body, trajectory = read_actor(actor, self._warnings)
            self._bodies.append(body)
            self._trajectories += [trajectory] if trajectory else []

    def read_model(self, element: Element, name: str, pose: np.ndarray) -> None:
        self._add_placed(self._models.model(element, element, Path(), name), pose)

    def read_include(self, include: Element, name: str, pose: np.ndarray) -> None:
        model = self._models.included(include, Path())
        if model is not None:
            model.name, model.placed_by = name, include
            self._add_placed(model, pose)

    def _add_placed(self, model: SdfModel, pose: np.ndarray) -> None:
        """Add a model where its <pose> places it in a frame at ``pose``, as gazebo_ros spawns it."""
        frames = SdfFrames({model.name: model.frames}.get)
        frames.declare(model.name, model.placed_by, inside=model.placement())
        self._add_model(model, pose @ frames.frame(model.name, model.element), None)

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
        if model.is_static:
            for joint in model.element.children("joint"):
                joint.mark_all()  # without effect in Gazebo, too
        else:
            self._add_joints(model, full_name)

    def _add_joints(self, model: SdfModel, name: str) -> None:
        links = dict(_links_of(model))
        elements = {joint.name: joint for joint in model.element.children("joint")}
        joints = [read_joint(joint, model, name, links, self._warnings) for joint in elements.values()]

        def warn(joint: Joint) -> None:
            self._warnings.skip(elements[joint.name[len(name) + 2 :]], "closes a loop, ignored")

        _skip_decay(model, name, joints, self._warnings)
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
        in_model = model.frames.frame(link.name, link)
        collisions = tuple(self._collisions(link, model, in_model, state))
        visuals = tuple(self._visuals(link, model, in_model, state))
        fixed = link.flag("kinematic") or model.is_static
        fixed = fixed or any(isinstance(part.shape, Plane) for part in collisions)
        gravity, inertial = link.child("gravity"), link.child("inertial")
        if fixed and inertial is not None:
            inertial.mark_all()
        return Body(
            name,
            in_world,
            collisions,
            None if fixed else read_mass(link),
            self._surface(link),
            inverse(outermost) @ in_world,
            visuals,
            Inertia() if fixed else read_inertia(link, self._warnings),
            read_damping(link, self._step),
            gravity is None or link.flag("gravity"),
            is_dock=model.is_dock and fixed,
        )

    def _collisions(
        self, link: Element, model: SdfModel, in_model: np.ndarray, state: ModelState
    ) -> Iterator[Collision]:
        for part in link.children("collision"):
            shape = self._collision_shape(part, model, state)
            if shape is not None:
                laser_retro = part.number("laser_retro", default=0.0)
                yield Collision(shape, _pose_in_link(part, link, model, in_model), laser_retro, part.name)

    def _visuals(
        self, link: Element, model: SdfModel, in_model: np.ndarray, state: ModelState
    ) -> Iterator[Visual]:
        for part in link.children("visual"):
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
        """Return the surface of a link's first collision, which counts for the whole link."""
        collisions = list(link.children("collision"))
        surfaces = [read_surface(collision, self._warnings) for collision in collisions]
        for collision, surface in zip(collisions, surfaces):
            element = collision.child("surface")
            if element is not None and surface != surfaces[0]:
                self._warnings.skip(element, f"{NO_EFFECT}: the surface of the link's first collision counts")
        return surfaces[0] if surfaces else SurfaceProperties()


def _physics(world: Element, warnings: SkippedElements) -> Tuple[float, float]:
    """Return gravity along z [m/s^2] and the step of physics [s] of a <world>."""
    step = GAZEBO_STEP
    for physics in world.children("physics"):
        step = physics.number("max_step_size", default=GAZEBO_STEP)
    gravity, of_physics = world.child("gravity"), world.child("physics", "gravity")
    gravity = gravity or of_physics
    if gravity is None:
        return -DEFAULT_GRAVITY, step
    x, y, z = gravity.numbers(3)
    if x or y:
        warnings.skip(gravity, "only its z acts")
    return z, step


def _skip_decay(model: SdfModel, name: str, joints: Sequence[Joint], warnings: SkippedElements) -> None:
    """Warn about <velocity_decay> of links that hang on joints, of a model with a full name."""
    children = {joint.child for joint in joints}
    for link in model.element.children("link"):
        decay = link.child("velocity_decay")
        if decay is not None and f"{name}::{link.name}" in children and any(read_damping(link, GAZEBO_STEP)):
            warnings.skip(decay, f"{NO_EFFECT} on a link that hangs on a joint")


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
