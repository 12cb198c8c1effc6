"""From an SDF file to a World: models, links, collisions and their poses."""

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
from sim_bridge.sdf.joints import read_joint, started, trees_of
from sim_bridge.sdf.lights import read_lights
from sim_bridge.sdf.models import ModelReader, SdfModel, declare_frames
from sim_bridge.sdf.shapes.colours import read_colour, read_glow
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


def load_world(path, model_folders: Sequence[Path] = (), strict: bool = False) -> World:
    """The world of an SDF file. ``model_folders`` are searched for ``model://`` (GAZEBO_MODEL_PATH).

    What cannot be honoured is named in the world's ``warnings``; if ``strict``, a mesh or model that is
    missing is an error. Raises WorldError.
    """
    path = Path(path)
    world = parse(path).required("world")
    reader = _Reader(tuple(Path(folder) for folder in model_folders), SkippedElements(strict))
    reader.read_world(world, path.parent)
    return reader.world(world.name, _gravity(world))


def read_model(
    xml, name: str, pose: np.ndarray, model_folders: Sequence[Path] = (), strict: bool = False
) -> World:
    """A world of the one model described by SDF text, called ``name`` and placed at ``pose`` (4, 4).

    Instead of a model the text may hold a world that includes it.
    """
    reader = _Reader(tuple(model_folders), SkippedElements(strict))
    root = parse_text(xml, name)
    include = root.child("world", "include")
    if include is not None:
        reader.read_include(include, name, pose)
    else:
        reader.read_model(root.required("model"), name, pose)
    return reader.world(name)


class _Reader:
    """Collects the bodies and joints of models, and what was left out."""

    def __init__(self, model_folders: Tuple[Path, ...], warnings: SkippedElements):
        self._bodies: List[Body] = []
        self._joints: List[Joint] = []
        self._robots: List[DrivenModel] = []
        self._lights: List[Light] = []
        self._trajectories: List[ScriptedTrajectory] = []
        self._model_folders = model_folders
        self._warnings = warnings
        self._models = ModelReader(model_folders, warnings)

    def world(self, name: str, gravity: float = DEFAULT_GRAVITY) -> World:
        """All that has been read."""
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
        self._warnings.check_children(world)
        for physics in world.children("physics"):
            self._warnings.check_children(physics)
        self._lights.extend(read_lights(world))
        states = list(world.children("state"))
        insertions = [inserted for state in states for inserted in state.children("insertions")]
        gone = [
            name.text for state in states for lost in state.children("deletions") for name in lost.children()
        ]
        overrides = read_states(states)
        parts = [world, *insertions]
        models = [model for part in parts for model in self._models.models_in(part, folder)]
        frames = SdfFrames({model.name: model.frames for model in models}.get)
        declare_frames(frames, world)
        for model in models:
            frames.declare(model.name, model.placed_by, inside=model.placement())
        for model in models:
            if model.name not in gone:
                self._put(model, frames.frame(model.name, model.element), overrides.get(model.name))
        for actor in world.children("actor"):
            body, course = read_actor(actor, self._warnings)
            self._bodies.append(body)
            self._trajectories += [course] if course else []

    def read_model(self, element: Element, name: str, pose: np.ndarray) -> None:
        self._put(self._models.model(element, element, Path(), name), pose, None)

    def read_include(self, include: Element, name: str, pose: np.ndarray) -> None:
        model = self._models.included(include, Path())
        if model is not None:
            model.name = name
            self._put(model, pose, None)

    def _put(self, model: SdfModel, in_world: np.ndarray, state: Optional[ModelState]) -> None:
        """Adds a model of the world, if it is driven as a robot."""
        bodies, joints = len(self._bodies), len(self._joints)
        self._place(model, in_world, state)
        if model.is_driven:
            robot = DrivenModel(
                model.name, model.element, tuple(self._bodies[bodies:]), tuple(self._joints[joints:])
            )
            self._robots.append(robot)
            del self._bodies[bodies:], self._joints[joints:]

    def _place(
        self,
        model: SdfModel,
        in_world: np.ndarray,
        state: Optional[ModelState],
        scope: str = "",
        outermost: Optional[np.ndarray] = None,
    ) -> None:
        """Adds each link of a model at ``in_world``, and of the models nested in it, as a body.

        ``outermost``: (4, 4), pose in the world of the outermost model that this one is nested in, if any.
        """
        state = state or ModelState()
        in_world = in_world if state.pose is None else state.pose
        outermost = in_world if outermost is None else outermost
        full_name = scope + model.name
        for link in model.element.children("link"):
            place = state.links.get(link.name, in_world @ model.frames.frame(link.name, link))
            self._bodies.append(self._body(link, model, f"{full_name}::{link.name}", place, outermost, state))
        for nested in model.nested:
            place = in_world @ model.frames.frame(nested.name, nested.element)
            self._place(nested, place, state.models.get(nested.name), full_name + "::", outermost)
        if not model.is_static:
            self._add_joints(model, full_name)

    def _add_joints(self, model: SdfModel, name: str) -> None:
        links = dict(_links_of(model))
        elements = {joint.name: joint for joint in model.element.children("joint")}
        joints = [read_joint(joint, model, name, links, self._warnings) for joint in elements.values()]

        def skip(joint: Joint) -> None:
            self._warnings.skip(elements[joint.name[len(name) + 2 :]], "closes a loop, left out")

        placed = {body.name: body.pose_in_world for body in self._bodies}
        in_model = {f"{name}::{link}": pose for link, pose in links.items()}
        for joint in trees_of(joints, skip):
            if joint.kind != "fixed" and joint.parent:
                before, now = (
                    inverse(poses[joint.parent]) @ poses[joint.child] for poses in (in_model, placed)
                )
                joint = started(joint, before, now)
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
        )

    def _collisions(
        self, link: Element, model: SdfModel, in_model: np.ndarray, state: ModelState
    ) -> Iterator[Collision]:
        for part in link.children("collision"):
            self._warnings.check_children(part)
            shape = self._solid(part, model, state)
            if shape is not None:
                laser_retro = part.number("laser_retro", default=0.0)
                yield Collision(shape, _pose_in_link(part, link, model, in_model), laser_retro, part.name)

    def _visuals(
        self, link: Element, model: SdfModel, in_model: np.ndarray, state: ModelState
    ) -> Iterator[Visual]:
        for part in link.children("visual"):
            self._warnings.check_children(part)
            look = self._look(part, model, state)
            if look is not None:
                placed = _pose_in_link(part, link, model, in_model)
                yield Visual(look, placed, read_colour(part), read_glow(part))

    def _look(self, part: Element, model: SdfModel, state: ModelState) -> Optional[VisualShape]:
        try:
            shape = read_shape(part.required("geometry"), model.folder, self._model_folders)
        except MissingMeshError as missing:
            shape = missing.instead
            self._warnings.missing(
                part, str(missing), "left out" if shape is None else "only its footprint is here"
            )
        except UnsupportedGeometryError as left_out:
            self._warnings.skip(part, f"{left_out}, left out", kind=("geometry", str(left_out)))
            return None
        x, y, z = state.scale
        return None if shape is None else scaled(shape, (x, y, z))

    def _solid(self, part: Element, model: SdfModel, state: ModelState) -> Optional[Shape]:
        look = self._look(part, model, state)
        return load_mesh(look) if isinstance(look, MeshFile) else cast(Optional[Shape], look)

    def _surface(self, link: Element) -> SurfaceProperties:
        """Of the link's first collision; friction at most 1: Gazebo's worlds say 100 for "grips"."""
        surface = link.child("collision", "surface")
        if surface is None:
            return SurfaceProperties()
        self._warnings.check_children(surface)
        mu = surface.number("friction", "ode", "mu", default=1.0)
        bounce = surface.number("bounce", "restitution_coefficient", default=0.0)
        return SurfaceProperties(min(max(mu, 0.0), 1.0), min(max(bounce, 0.0), 1.0))


def _links_of(model: SdfModel, scope: str = "") -> List[Tuple[str, np.ndarray]]:
    """The links of a model and of those nested in it by their names there, with their poses (4, 4) in it."""
    links = [
        (scope + link.name, model.frames.frame(link.name, link)) for link in model.element.children("link")
    ]
    for nested in model.nested:
        place = model.frames.frame(nested.name, nested.element)
        links += [(scope + name, place @ pose) for name, pose in _links_of(nested, f"{nested.name}::")]
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
