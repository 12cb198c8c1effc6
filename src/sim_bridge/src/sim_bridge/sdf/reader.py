"""From an SDF file to a World: includes, models, links, collisions and their poses."""

from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from sim_bridge.sdf.element import Element, parse, parse_text
from sim_bridge.sdf.geometry import LeftOutError, read_shape
from sim_bridge.sdf.includes import model_file, resolve
from sim_bridge.sdf.state import ModelState, read_states
from sim_bridge.shapes import Plane
from sim_bridge.world import Body, Collision, World

MAX_INCLUDE_DEPTH = 20
DEFAULT_GRAVITY = 9.8
# Elements that have no bearing on what moves, collides or is measured.
SCENERY = {"light", "scene", "gui", "physics", "spherical_coordinates", "magnetic_field", "atmosphere"}
SCENERY |= {"wind", "audio", "gravity", "state", "model", "include"}


def load_world(path, model_folders: Sequence[Path] = ()) -> World:
    """The world of an SDF file. ``model_folders`` are searched for ``model://`` (GAZEBO_MODEL_PATH).

    What cannot be honoured is named in the world's ``warnings``. Raises WorldError.
    """
    path = Path(path)
    root = parse(path)
    world = root.required("world")
    reader = _Reader(tuple(Path(folder) for folder in model_folders))
    states = list(world.children("state"))
    insertions = [inserted for state in states for inserted in state.children("insertions")]
    deleted = {
        name.text
        for state in states
        for gone in state.children("deletions")
        for name in gone.children("name")
    }
    overrides = read_states(states)
    for part in [world, *insertions]:
        for model in part.children("model"):
            if model.name not in deleted:
                reader.add_model(model, path.parent, overrides.get(model.name))
        for include in part.children("include"):
            reader.add_include(include, path.parent, overrides)
    for element in world.children():
        if element.tag not in SCENERY:
            reader.leave_out(element)
    return World(world.name, tuple(reader.bodies), _gravity(world), tuple(reader.warnings))


def read_model(xml, name: str, pose: np.ndarray, model_folders: Sequence[Path] = ()) -> World:
    """A world of the one model described by SDF text, called ``name`` and placed at ``pose`` (4, 4)."""
    model = parse_text(xml, name).required("model")
    reader = _Reader(tuple(model_folders))
    reader.add_model(model, Path(), ModelState(pose=pose), name=name)
    return World(name, tuple(reader.bodies), warnings=tuple(reader.warnings))


class _Reader:
    """Collects the bodies of models, and what was left out."""

    def __init__(self, model_folders: Tuple[Path, ...]):
        self.bodies: List[Body] = []
        self.warnings: List[str] = []
        self._model_folders = model_folders

    def leave_out(self, element: Element, why: str = "left out") -> None:
        library = element.attribute("filename")
        self.warnings.append(f"{element.place}{f' ({library})' if library else ''}: {why}")

    def add_include(
        self,
        include: Element,
        folder: Path,
        overrides: Dict[str, ModelState],
        parent_in_world: Optional[np.ndarray] = None,
        scope: str = "",
        static: bool = False,
        depth: int = 0,
        outermost: Optional[np.ndarray] = None,
    ) -> None:
        """Adds the model that an <include> names; its own <name>, <pose> and <static> win."""
        if depth >= MAX_INCLUDE_DEPTH:
            raise include.error("includes itself")
        uri = include.required("uri").text
        name_element = include.child("name")
        name = name_element.text if name_element is not None else ""
        built_in = uri.rstrip("/").rsplit("/", 1)[-1]
        if uri.startswith("model://") and built_in == "sun":
            return
        pose = include.pose()
        if uri.startswith("model://") and built_in == "ground_plane":
            state = overrides.get(name or built_in)
            pose = state.pose if state is not None and state.pose is not None else pose
            self.bodies.append(Body(f"{name or built_in}::link", pose, (Collision(Plane(), np.eye(4)),)))
            return
        found = resolve(uri, folder, self._model_folders)
        if found is None:
            self.leave_out(include, f"model {uri} not found, left out")
            return
        file = model_file(found)
        model = parse(file).required("model")
        self.add_model(
            model,
            file.parent,
            overrides.get(name or model.name),
            name=name,
            pose=pose if include.child("pose") is not None else None,
            parent_in_world=parent_in_world,
            scope=scope,
            static=static or include.flag("static"),
            depth=depth + 1,
            outermost=outermost,
        )

    def add_model(
        self,
        model: Element,
        folder: Path,
        state: Optional[ModelState],
        name: str = "",
        pose: Optional[np.ndarray] = None,
        parent_in_world: Optional[np.ndarray] = None,
        scope: str = "",
        static: bool = False,
        depth: int = 0,
        outermost: Optional[np.ndarray] = None,
    ) -> None:
        """Adds each link of a model, and of the models nested in it, as a body.

        ``outermost``: (4, 4), pose in the world of the outermost model that this one is nested in, if any.
        """
        state = state or ModelState()
        full_name = scope + (name or model.name)
        in_parent = model.pose() if pose is None else pose
        in_world = in_parent if parent_in_world is None else parent_in_world @ in_parent
        if state.pose is not None:
            in_world = state.pose
        outermost = in_world if outermost is None else outermost
        joints = list(model.children("joint"))
        static = static or model.flag("static")
        for joint in joints:
            self.leave_out(joint, "left out" if static else "left out, the model is held in place")
        for plugin in model.children("plugin"):
            self.leave_out(plugin)
        for link in model.children("link"):
            link_in_world = state.links.get(link.name, in_world @ link.pose())
            name_of_link = f"{full_name}::{link.name}"
            self._add_link(link, folder, name_of_link, link_in_world, static or bool(joints), outermost)
        for nested in model.children("model"):
            self.add_model(
                nested,
                folder,
                state.models.get(nested.name),
                parent_in_world=in_world,
                scope=full_name + "::",
                static=static,
                depth=depth,
                outermost=outermost,
            )
        for include in model.children("include"):
            self.add_include(
                include, folder, state.models, in_world, full_name + "::", static, depth, outermost
            )

    def _add_link(
        self,
        link: Element,
        folder: Path,
        name: str,
        in_world: np.ndarray,
        static: bool,
        outermost: np.ndarray,
    ) -> None:
        for tag in ("sensor", "plugin"):
            for element in link.children(tag):
                self.leave_out(element)
        collisions = []
        for collision in link.children("collision"):
            try:
                shape = read_shape(collision.required("geometry"), folder, self._model_folders)
            except LeftOutError as missing:
                self.leave_out(collision, f"{missing}, left out")
                continue
            collisions.append(Collision(shape, collision.pose()))
        if collisions:
            fixed = static or any(isinstance(part.shape, Plane) for part in collisions)
            mass = None if fixed else _mass(link)
            in_model = np.linalg.inv(outermost) @ in_world
            self.bodies.append(Body(name, in_world, tuple(collisions), mass, _friction(link), in_model))


def _mass(link: Element) -> float:
    mass = link.child("inertial", "mass")
    return mass.lengths(1)[0] if mass is not None else 1.0


def _friction(link: Element) -> float:
    """Coulomb's coefficient of the link's first collision, at most 1: Gazebo's worlds say 100 for "grips"."""
    mu = link.child("collision", "surface", "friction", "ode", "mu")
    return min(max(mu.numbers(1)[0], 0.0), 1.0) if mu is not None else 1.0


def _gravity(world: Element) -> float:
    gravity = world.child("gravity") or world.child("physics", "gravity")
    return -gravity.numbers(3)[2] if gravity is not None else DEFAULT_GRAVITY
