"""Joints of models, by name."""

from dataclasses import replace
from typing import Dict, Iterable, List, Mapping, Sequence, Set

from planar.config.hints import hint
from sim_bridge.errors import UnknownEntityError
from sim_bridge.physics.engine import Engine
from sim_bridge.physics.joints import JointState
from sim_bridge.world import Joint


class ModelJoints:
    """Joints by their names, ``model::joint``.

    Methods that take a name raise UnknownEntityError if there is no such joint.

    Args:
        engine: Holds the joints.
    """

    def __init__(self, engine: Engine):
        self._engine = engine
        self._joints: Dict[str, Joint] = {}

    def all(self) -> List[Joint]:
        """Return all joints with their present limits and damping."""
        return list(self._joints.values())

    def add(self, joints: Sequence[Joint]) -> None:
        """Add joints whose bodies are in the engine."""
        self._joints.update((joint.name, joint) for joint in joints)

    def remove_model(self, model: str) -> List[str]:
        """Remove the joints of a model.

        Returns:
            Names of the removed joints.
        """
        removed = [joint.name for joint in self._joints.values() if joint.model == model]
        for name in removed:
            del self._joints[name]
        return removed

    def joints_of(self, model: str) -> List[str]:
        """Return the names, ``model::joint``, of a model's joints."""
        return [joint.name for joint in self._joints.values() if joint.model == model]

    def movable_joints_of(self, model: str) -> List[str]:
        """Return the names, ``model::joint``, of a model's joints that are not fixed."""
        return [
            joint.name for joint in self._joints.values() if joint.model == model and joint.kind != "fixed"
        ]

    def root_links(self, links: Iterable[str]) -> List[str]:
        """Return those of some links that are no child of another link; their children move with them."""
        children: Set[str] = {joint.child for joint in self._joints.values() if joint.parent}
        return [link for link in links if link not in children]

    def full_name(self, name: str) -> str:
        """Return the full name, ``model::joint``, of a joint.

        Args:
            name: Name with or without its model; the first joint of that name is used.
        """
        for known in self._joints:
            if known == name or known.endswith("::" + name):
                return known
        raise self._unknown(name)

    def get(self, name: str) -> Joint:
        """Return a joint's description."""
        if name not in self._joints:
            raise self._unknown(name)
        return self._joints[name]

    def state(self, name: str) -> JointState:
        """Return the state of a joint that is not fixed."""
        return self._engine.joints.state(self.get(name).name)

    def set_positions(self, positions: Mapping[str, float]) -> None:
        """Set joint positions at zero speed; fixed joints are ignored.

        Args:
            positions: Position [rad or m] by joint name.
        """
        for name, position in positions.items():
            if self.get(name).kind != "fixed":
                self._engine.joints.set_state(name, JointState(position, 0.0))

    def reset_positions(self) -> None:
        """Set all joints to their start positions."""
        self.set_positions({joint.name: joint.start for joint in self._joints.values()})

    def set_limits(self, name: str, lower: float, upper: float, damping: float) -> None:
        """Set the limits and the damping of a joint; a fixed joint stays fixed.

        Args:
            name: Name of the joint.
            lower: Lower limit [rad or m].
            upper: Upper limit [rad or m].
            damping: Viscous damping [N m s/rad or N s/m].
        """
        self._joints[name] = replace(self.get(name), lower=lower, upper=upper, damping=damping)
        if self._joints[name].kind != "fixed":
            self._engine.joints.set_limits(name, lower, upper, damping)

    def _unknown(self, name: str) -> UnknownEntityError:
        return UnknownEntityError(f"no joint named {name!r}{hint(name, self._joints)}")
