"""The joints of models, by name."""

from dataclasses import replace
from typing import Dict, Iterable, List, Mapping, Sequence, Set

from planar.config.hints import hint
from sim_bridge.errors import UnknownEntityError
from sim_bridge.physics.engine import Engine
from sim_bridge.physics.joints import JointState
from sim_bridge.world import Joint


class ModelJoints:
    """A joint is known by ``model::joint``. What takes a name raises UnknownEntityError if there is none."""

    def __init__(self, engine: Engine):
        self._engine = engine
        self._joints: Dict[str, Joint] = {}

    def all(self) -> List[Joint]:
        """The joints as they are described now."""
        return list(self._joints.values())

    def add(self, joints: Sequence[Joint]) -> None:
        """Joints of bodies that are in the engine."""
        self._joints.update((joint.name, joint) for joint in joints)

    def remove_model(self, model: str) -> List[str]:
        """A model is gone; returns the names of its joints."""
        gone = [joint.name for joint in self._joints.values() if joint.model == model]
        for name in gone:
            del self._joints[name]
        return gone

    def movable_joints_of(self, model: str) -> List[str]:
        """The names of a model's joints that move, ``model::joint``."""
        return [
            joint.name for joint in self._joints.values() if joint.model == model and joint.kind != "fixed"
        ]

    def root_links(self, links: Iterable[str]) -> List[str]:
        """Those links that no joint holds to another: what hangs on them moves with them."""
        held: Set[str] = {joint.child for joint in self._joints.values() if joint.parent}
        return [link for link in links if link not in held]

    def full_name(self, name: str) -> str:
        """The name ``model::joint`` of the first joint that is called so, with its model or without."""
        for known in self._joints:
            if known == name or known.endswith("::" + name):
                return known
        raise self._unknown(name)

    def get(self, name: str) -> Joint:
        if name not in self._joints:
            raise self._unknown(name)
        return self._joints[name]

    def state(self, name: str) -> JointState:
        """Of a joint that moves."""
        return self._engine.joints.state(self.get(name).name)

    def set_positions(self, positions: Mapping[str, float]) -> None:
        """Puts joints to positions, rad or m, at rest; those that are fixed stay so."""
        for name, position in positions.items():
            if self.get(name).kind != "fixed":
                self._engine.joints.set_state(name, JointState(position, 0.0))

    def reset_positions(self) -> None:
        """Puts all joints to where they started."""
        self.set_positions({joint.name: joint.start for joint in self._joints.values()})

    def set_limits(self, name: str, lower: float, upper: float, damping: float) -> None:
        """Limits in rad or m, ``damping`` in N m s/rad or N s/m; a joint that is fixed stays so."""
        self._joints[name] = replace(self.get(name), lower=lower, upper=upper, damping=damping)
        if self._joints[name].kind != "fixed":
            self._engine.joints.set_limits(name, lower, upper, damping)

    def _unknown(self, name: str) -> UnknownEntityError:
        return UnknownEntityError(f"no joint named {name!r}{hint(name, self._joints)}")
