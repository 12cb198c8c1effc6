"""Links and joints, and the few rigid parts that physics needs of them: a base and its driven wheels."""

from dataclasses import dataclass, field
from typing import Dict, Iterable, List, Sequence, Tuple

import numpy as np

from sim_bridge.errors import RobotError
from sim_bridge.geometry.pose3 import IDENTITY, transform_points
from sim_bridge.geometry.shapes import outline
from sim_bridge.sdf.element import Element
from sim_bridge.world import Collision


@dataclass(frozen=True, eq=False)
class RobotLink:
    """``mass`` in kg, 0 if none is given; ``centre`` (3,) of it in the link's frame.

    ``inertia``: (3, 3), kg m^2, about the centre along the axes of the link's frame.
    """

    name: str
    mass: float
    centre: np.ndarray
    inertia: np.ndarray
    collisions: Tuple[Collision, ...]


@dataclass(frozen=True, eq=False)
class RobotJoint:
    """``child_in_parent``: (4, 4) at the joint's zero; ``axis``: (3,), in the child's frame."""

    name: str
    parent: str
    child: str
    child_in_parent: np.ndarray
    axis: np.ndarray


@dataclass(frozen=True, eq=False)
class RigidPart:
    """Links that are fixed to each other; ``name``: of the first of them.

    ``mass`` in kg, ``centre_of_mass`` (3,) in the part's frame, ``inertia`` (3,) about it along the axes of
    that frame, kg m^2.
    """

    name: str
    mass: float
    centre_of_mass: np.ndarray
    inertia: np.ndarray
    collisions: Tuple[Collision, ...]


@dataclass(frozen=True, eq=False)
class Wheel:
    """A part that turns about ``axis`` (3,), mounted at ``origin_in_base`` (4, 4)."""

    part: RigidPart
    origin_in_base: np.ndarray
    axis: np.ndarray


@dataclass(frozen=True, eq=False)
class RobotModel:
    """The base in its root frame, and the driven wheels by the names of their joints."""

    base: RigidPart
    wheels: Dict[str, Wheel]

    @property
    def radius(self) -> float:
        """Of the circle about the base's origin that holds all solid parts, metres."""
        return max((float(np.hypot(*point[:2])) for point in self._outline()), default=0.0)

    @property
    def lowest(self) -> float:
        """The height in the base's frame of what touches a floor, metres."""
        return min((float(point[2]) for point in self._outline()), default=0.0)

    def _outline(self) -> Iterable[np.ndarray]:
        wheels = [(wheel.origin_in_base, wheel.part) for wheel in self.wheels.values()]
        for part_in_base, part in [(IDENTITY, self.base), *wheels]:
            for collision in part.collisions:
                yield from transform_points(part_in_base @ collision.pose_in_body, outline(collision.shape))


class RobotStructure:
    """The tree of a robot's links. Raises RobotError if it is none; ``name`` of the robot is for errors."""

    def __init__(self, name: str, links: Sequence[RobotLink], joints: Sequence[RobotJoint]):
        self.name = name
        self.links = {link.name: link for link in links}
        self.joints = {joint.name: joint for joint in joints}
        self._from_child = {joint.child: joint for joint in joints}
        for joint in joints:
            for end, link in (("parent", joint.parent), ("child", joint.child)):
                if link not in self.links:
                    raise RobotError(f"robot {name}: joint {joint.name}: its {end} {link!r} is no link")
        roots = [link for link in self.links if link not in self._from_child]
        if len(roots) != 1:
            raise RobotError(f"robot {name}: expected one root link, got {', '.join(roots) or 'none'}")
        self.root = roots[0]
        self._check_that_all_hang_together()

    def _check_that_all_hang_together(self) -> None:
        """The ways up from all links end at the root, so that none goes round for ever."""
        reached = {self.root}
        for link in self.links:
            way: List[str] = []
            while link not in reached and link not in way:
                way.append(link)
                link = self._from_child[link].parent
            if link not in reached:
                joints = ", ".join(self._from_child[each].name for each in way[way.index(link) :])
                raise RobotError(f"robot {self.name}: these joints go round in a circle: {joints}")
            reached.update(way)

    def pose_in_base(self, link: str) -> np.ndarray:
        """Where a link is, (4, 4) in the root's frame, with all joints at zero. Raises RobotError."""
        if link not in self.links:
            raise RobotError(f"robot {self.name}: no link named {link!r}")
        in_base = IDENTITY
        while link != self.root:
            joint = self._from_child[link]
            in_base = joint.child_in_parent @ in_base
            link = joint.parent
        return in_base

    def assemble(self, driven: Iterable[str]) -> RobotModel:
        """The base and the wheels on the joints ``driven``; all other joints are held as they are.

        Raises RobotError if one of the joints is not there.
        """
        wheel_joints = [self._joint(name) for name in driven]
        wheels = {
            joint.name: Wheel(
                self._part(joint.child, wheel_joints), self.pose_in_base(joint.child), joint.axis
            )
            for joint in wheel_joints
        }
        return RobotModel(self._part(self.root, wheel_joints), wheels)

    def _joint(self, name: str) -> RobotJoint:
        if name not in self.joints:
            raise RobotError(
                f"robot {self.name}: its drive names the joint {name!r}, which is not there "
                f"(joints: {', '.join(self.joints) or 'none'})"
            )
        return self.joints[name]

    def _part(self, first: str, wheel_joints: Sequence[RobotJoint]) -> RigidPart:
        """All links that hang on ``first`` without a driven wheel between."""
        fixed: List[Tuple[RobotLink, np.ndarray]] = [(self.links[first], IDENTITY)]
        for link, link_in_part in fixed:
            for joint in self._from_child.values():
                if joint.parent == link.name and joint not in wheel_joints:
                    fixed.append((self.links[joint.child], link_in_part @ joint.child_in_parent))
        return self._merged(fixed)

    def _merged(self, links: Sequence[Tuple[RobotLink, np.ndarray]]) -> RigidPart:
        """Masses add up, inertias by the parallel axis theorem."""
        name = links[0][0].name
        mass = sum(link.mass for link, _ in links)
        if mass <= 0.0:
            raise RobotError(f"robot {self.name}: link {name}: a part that moves needs a mass")
        centres = [transform_points(pose, link.centre[None])[0] for link, pose in links]
        centre = np.average(centres, axis=0, weights=[link.mass for link, _ in links])
        total = np.zeros(3)
        for (link, pose), at in zip(links, centres):
            arm = at - centre
            turned = pose[:3, :3] @ link.inertia @ pose[:3, :3].T
            total += np.diag(turned) + link.mass * (arm @ arm - arm * arm)
        collisions = tuple(
            Collision(part.shape, pose @ part.pose_in_body)
            for link, pose in links
            for part in link.collisions
        )
        return RigidPart(name, mass, centre, total, collisions)


@dataclass
class GazeboElements:
    """<plugin> elements of a model, and <sensor> elements, each with the link that it is fixed to."""

    plugins: List[Element] = field(default_factory=list)
    sensors: List[Tuple[str, Element]] = field(default_factory=list)

    def add(self, parent: Element, link: str) -> None:
        """Takes what is directly below an element: <gazebo> of URDF, <model> or <link> of SDF."""
        self.plugins.extend(parent.children("plugin"))
        self.sensors.extend((link, sensor) for sensor in parent.children("sensor"))
