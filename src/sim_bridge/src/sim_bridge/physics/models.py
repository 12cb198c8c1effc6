"""Models, robots among them, and their links, by name."""

from typing import Dict, Iterable, List, Sequence

from planar.config.hints import hint
from planar.geometry.limits import MAX_COORDINATE
from sim_bridge.errors import UnknownEntityError, WorldError
from sim_bridge.geometry.pose3 import inverse
from sim_bridge.physics.engine import Engine, MassProperties
from sim_bridge.physics.kinematics import KinematicState, at_rest
from sim_bridge.physics.model_joints import ModelJoints
from sim_bridge.physics.vehicle import Vehicle
from sim_bridge.views.scene_view import SceneView
from sim_bridge.world import Body


class Models:
    """What there is in an engine, and in sight; a link is known by ``model::link``, a robot is a model.

    What takes a name raises UnknownEntityError if there is nothing of that name.
    """

    def __init__(self, engine: Engine, joints: ModelJoints, view: SceneView):
        self._engine = engine
        self._joints = joints
        self._view = view
        self._bodies: Dict[str, Body] = {}
        self._vehicles: Dict[str, Vehicle] = {}

    def add(self, bodies: Sequence[Body]) -> None:
        """Bodies that are in the engine."""
        for body in bodies:
            self._bodies[body.name] = body
            self._view.add(body)

    def add_vehicle(self, vehicle: Vehicle) -> None:
        """A robot that is in the engine."""
        self._vehicles[vehicle.name] = vehicle
        self._view.add(vehicle.body())

    def remove(self, name: str) -> List[str]:
        """Takes a model out of the engine and out of sight; returns the names of its links."""
        links = self.links_of(name)
        vehicle = self._vehicles.pop(name, None)
        for link in [vehicle.base] if vehicle else links:
            if self._engine.has_link(link):
                self._engine.remove(link)
            self._bodies.pop(link, None)
            self._view.remove(link)
        self._view.remove_viewer(name)
        return links

    def bodies(self) -> List[Body]:
        """Of all models but robots, as they were put into the world."""
        return list(self._bodies.values())

    def names(self) -> List[str]:
        return list(dict.fromkeys([*(body.model for body in self._bodies.values()), *self._vehicles]))

    def check_free(self, names: Iterable[str]) -> None:
        """Raises WorldError if a model has one of these names."""
        for taken in set(names).intersection(self.names()):
            raise WorldError(f"{taken} is in the world already")

    def links_of(self, model: str) -> List[str]:
        """The names of a model's links; the first is the one that its pose is told by."""
        if model in self._vehicles:
            return list(self._vehicles[model].links)
        links = [body.name for body in self._bodies.values() if body.model == model]
        if not links:
            raise _unknown("model", model, self.names())
        return links

    def collisions_of(self, model: str) -> List[str]:
        """The names of the collisions of a model."""
        bodies = (body for body in self._bodies.values() if body.model == model)
        return [part.name for body in bodies for part in body.collisions]

    def is_static(self, model: str) -> bool:
        """Whether nothing of a model can move."""
        return model not in self._vehicles and all(
            self._bodies[link].mass is None for link in self.links_of(model)
        )

    def state(self, name: str) -> KinematicState:
        """Where a model's frame is and how it moves."""
        link = self.links_of(name)[0]
        motion = self._engine.state_of(link)
        return motion.of_frame(inverse(self._bodies[link].pose_in_model)) if link in self._bodies else motion

    def set_state(self, name: str, motion: KinematicState) -> None:
        """Puts a model with all its links to another place, and sets its velocity."""
        from_here = motion.pose @ inverse(self.state(name).pose)
        vehicle = self._vehicles.get(name)
        for link in [vehicle.base] if vehicle else self._joints.root_links(self.links_of(name)):
            self._put(link, motion.at(from_here @ self._engine.pose_of(link)))

    def reset_poses(self) -> None:
        """Puts all models but robots back to where they were put into the world, at rest."""
        for name in self._joints.root_links(self._bodies):
            self._put(name, at_rest(self._bodies[name].pose_in_world))

    def full_link_name(self, name: str) -> str:
        """The name ``model::link`` of the first link that is called so, with its model or without."""
        known = self._links()
        for link in known:
            if link == name or link.endswith("::" + name):
                return link
        raise _unknown("link", name, known)

    def check_link(self, link: str) -> None:
        """Raises UnknownEntityError."""
        model = link.split("::", 1)[0]
        if model not in self.names() or link not in self.links_of(model):
            raise _unknown("link", link, self._links())

    def link_state(self, link: str) -> KinematicState:
        self.check_link(link)
        return self._engine.state_of(link)

    def set_link_state(self, link: str, motion: KinematicState) -> None:
        self.check_link(link)
        self._put(link, motion)

    def mass_properties(self, link: str) -> MassProperties:
        self.check_link(link)
        return self._engine.mass_properties(link)

    def set_mass(self, link: str, mass: float, moments: Sequence[float], has_gravity: bool) -> None:
        """``mass`` in kg, ``moments`` (3,) about the link's principal axes, kg m^2, and whether it falls.

        Raises WorldError for what nothing can weigh.
        """
        self.check_link(link)
        if not all(0.0 < value <= MAX_COORDINATE for value in (mass, *moments)):
            raise WorldError("mass and moments of inertia must be positive, and no larger than 1e6")
        self._engine.set_mass(link, mass, moments, has_gravity)

    def _links(self) -> List[str]:
        return [link for model in self.names() for link in self.links_of(model)]

    def _put(self, link: str, motion: KinematicState) -> None:
        self._engine.set_state(link, motion)
        self._view.move(link, motion.pose)


def _unknown(kind: str, name: str, known: Iterable[str]) -> UnknownEntityError:
    return UnknownEntityError(f"no {kind} named {name!r}{hint(name, known)}")
