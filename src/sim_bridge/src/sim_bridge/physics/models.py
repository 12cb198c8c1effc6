"""Models, including robots, and their links, by name."""

from typing import Dict, Iterable, List, Sequence

from planar import Pose2
from planar.config.hints import hint
from planar.geometry.limits import MAX_COORDINATE
from sim_bridge.errors import UnknownEntityError, WorldError
from sim_bridge.geometry.pose3 import from_pose2, inverse
from sim_bridge.physics.engine import Engine, MassProperties
from sim_bridge.physics.kinematics import KinematicState, at_rest
from sim_bridge.physics.model_joints import ModelJoints
from sim_bridge.physics.vehicle import Vehicle
from sim_bridge.views.scene_view import SceneView
from sim_bridge.world import Body


class Models:
    """The models of a scene; links are named ``model::link``, and a robot is a model.

    Keeps the engine and the sensors' view of the scene consistent. Methods that take a name raise
    UnknownEntityError if there is no such model or link.

    Args:
        engine: Holds the links.
        joints: Joints of the models.
        view: The sensors' view of the scene.
    """

    def __init__(self, engine: Engine, joints: ModelJoints, view: SceneView):
        self._engine = engine
        self._joints = joints
        self._view = view
        self._bodies: Dict[str, Body] = {}
        self._vehicles: Dict[str, Vehicle] = {}

    def add(self, bodies: Sequence[Body]) -> None:
        """Add bodies that are in the engine."""
        for body in bodies:
            self._bodies[body.name] = body
            self._view.add(body)

    def add_vehicle(self, vehicle: Vehicle) -> None:
        """Add a robot that is in the engine."""
        self._vehicles[vehicle.name] = vehicle
        self._view.add(vehicle.body())

    def remove(self, name: str) -> List[str]:
        """Remove a model from the engine and from view.

        Returns:
            Names of its links.
        """
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
        """Return the bodies of all models except robots, as they were added."""
        return list(self._bodies.values())

    def names(self) -> List[str]:
        """Return the names of all models."""
        return list(dict.fromkeys([*(body.model for body in self._bodies.values()), *self._vehicles]))

    def check_free(self, names: Iterable[str]) -> None:
        """Check that no model has one of these names.

        Raises:
            WorldError: A name is taken.
        """
        for taken in set(names).intersection(self.names()):
            raise WorldError(f"{taken} is in the world already")

    def links_of(self, model: str) -> List[str]:
        """Return the names of a model's links, the one that carries the model's frame first."""
        if model in self._vehicles:
            return list(self._vehicles[model].links)
        links = [body.name for body in self._bodies.values() if body.model == model]
        if not links:
            raise _unknown("model", model, self.names())
        return links

    def collisions_of(self, model: str) -> List[str]:
        """Return the names of the collisions of a model."""
        bodies = (body for body in self._bodies.values() if body.model == model)
        return [part.name for body in bodies for part in body.collisions]

    def is_static(self, model: str) -> bool:
        """Return whether no link of a model can move."""
        return model not in self._vehicles and all(
            self._bodies[link].mass is None for link in self.links_of(model)
        )

    def state(self, name: str) -> KinematicState:
        """Return the pose and velocity of a model's frame in the world."""
        link = self.links_of(name)[0]
        state = self._engine.state_of(link)
        return state.of_frame(inverse(self._bodies[link].pose_in_model)) if link in self._bodies else state

    def move_level(self, name: str, pose: Pose2) -> None:
        """Put a model, upright and at rest, elsewhere at its height; nothing happens if there is none.

        Args:
            name: Name of the model.
            pose: Pose in the world.
        """
        if name in self.names():
            self.set_state(name, at_rest(from_pose2(pose, z=float(self.state(name).pose[2, 3]))))

    def set_state(self, name: str, state: KinematicState) -> None:
        """Set the pose and velocity of a model with all its links.

        Args:
            name: Name of the model.
            state: Pose and velocity of the model's frame in the world.
        """
        displacement = state.pose @ inverse(self.state(name).pose)
        vehicle = self._vehicles.get(name)
        for link in [vehicle.base] if vehicle else self._joints.root_links(self.links_of(name)):
            self._set_state(link, state.at(displacement @ self._engine.pose_of(link)))

    def reset_poses(self) -> None:
        """Move all models except robots back to where they were added, at rest."""
        for name in self._joints.root_links(self._bodies):
            self._set_state(name, at_rest(self._bodies[name].pose_in_world))

    def full_link_name(self, name: str) -> str:
        """Return the full name, ``model::link``, of a link.

        Args:
            name: Name with or without its model; the first link of that name is used.
        """
        known = self._links()
        for link in known:
            if link == name or link.endswith("::" + name):
                return link
        raise _unknown("link", name, known)

    def check_link(self, link: str) -> None:
        """Check that a link exists.

        Raises:
            UnknownEntityError: There is no such link.
        """
        model = link.split("::", 1)[0]
        if model not in self.names() or link not in self.links_of(model):
            raise _unknown("link", link, self._links())

    def link_state(self, link: str) -> KinematicState:
        """Return the pose and velocity of a link's frame in the world."""
        self.check_link(link)
        return self._engine.state_of(link)

    def set_link_state(self, link: str, state: KinematicState) -> None:
        """Set the pose and velocity of a link, with its whole multibody.

        Args:
            link: Name of the link.
            state: Pose and velocity of the link's frame in the world.
        """
        self.check_link(link)
        self._set_state(link, state)

    def mass_properties(self, link: str) -> MassProperties:
        """Return the mass properties of a link."""
        self.check_link(link)
        return self._engine.mass_properties(link)

    def set_mass(self, link: str, mass: float, moments: Sequence[float], has_gravity: bool) -> None:
        """Set the mass properties of a link.

        Args:
            link: Name of the link.
            mass: Mass [kg].
            moments: Principal moments of inertia (3,) [kg m^2].
            has_gravity: Whether gravity acts on the link.

        Raises:
            WorldError: The mass or a moment is not positive or too large.
        """
        self.check_link(link)
        if not all(0.0 < value <= MAX_COORDINATE for value in (mass, *moments)):
            raise WorldError("mass and moments of inertia must be positive, and no larger than 1e6")
        self._engine.set_mass(link, mass, moments, has_gravity)

    def _links(self) -> List[str]:
        return [link for model in self.names() for link in self.links_of(model)]

    def _set_state(self, link: str, state: KinematicState) -> None:
        self._engine.set_state(link, state)
        self._view.move(link, state.pose)


def _unknown(kind: str, name: str, known: Iterable[str]) -> UnknownEntityError:
    return UnknownEntityError(f"no {kind} named {name!r}{hint(name, known)}")
