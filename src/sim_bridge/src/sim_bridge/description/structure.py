"""The link tree of a robot, and the rigid parts that physics needs: a base and its driven wheels."""

from dataclasses import dataclass, field
from typing import Dict, Iterable, List, Mapping, Sequence, Tuple

import numpy as np

from sim_bridge.errors import RobotError
from sim_bridge.geometry.pose3 import IDENTITY, transform_points
from sim_bridge.geometry.shapes import outline_points
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.warnings import SkippedElements
from sim_bridge.world import Collision


@dataclass(frozen=True, eq=False)
class RobotLink:
    """A link of a description.

    Attributes:
        name: Name of the link.
        mass: Mass [kg]; 0 if none is given.
        centre: Centre of mass (3,) in the link frame [m].
        inertia: Inertia matrix (3, 3) about the centre, along the axes of the link frame [kg m^2].
        collisions: Solid parts.
    """

    name: str
    mass: float
    centre: np.ndarray
    inertia: np.ndarray
    collisions: Tuple[Collision, ...]


@dataclass(frozen=True, eq=False)
class RobotJoint:
    """A joint of a description.

    Attributes:
        name: Name of the joint.
        parent: Name of the parent link.
        child: Name of the child link.
        child_in_parent: Pose (4, 4) of the child in the parent at position 0.
        axis: Unit vector (3,) in the child's frame.
    """

    name: str
    parent: str
    child: str
    child_in_parent: np.ndarray
    axis: np.ndarray


@dataclass(frozen=True, eq=False)
class RigidPart:
    """Links that are fixed to each other.

    Attributes:
        name: Name of the first link, whose frame is the part's.
        mass: Mass [kg].
        centre_of_mass: Centre of mass (3,) in the part's frame [m].
        inertia: Moments of inertia (3,) about the centre of mass, along the part's axes [kg m^2].
        collisions: Solid parts.
    """

    name: str
    mass: float
    centre_of_mass: np.ndarray
    inertia: np.ndarray
    collisions: Tuple[Collision, ...]


@dataclass(frozen=True, eq=False)
class Wheel:
    """A part that rotates about an axis.

    Attributes:
        part: The links of the wheel.
        origin_in_base: Pose (4, 4) of the part's frame in the base frame.
        axis: Unit vector (3,) of the axis in the part's frame.
        friction: Coefficient of friction.
    """

    part: RigidPart
    origin_in_base: np.ndarray
    axis: np.ndarray
    friction: float = 1.0


@dataclass(frozen=True, eq=False)
class RobotModel:
    """The rigid parts of a robot.

    Attributes:
        base: The base, with all links that are not on a driven wheel.
        wheels: Driven wheels by joint name.
    """

    base: RigidPart
    wheels: Dict[str, Wheel]

    @property
    def radius(self) -> float:
        """Radius of the circle around the base's origin that contains all collisions [m]."""
        return max((float(np.hypot(*point[:2])) for point in self._outline()), default=0.0)

    @property
    def lowest(self) -> float:
        """Height of the lowest point in the base frame [m]."""
        return min((float(point[2]) for point in self._outline()), default=0.0)

    def _outline(self) -> Iterable[np.ndarray]:
        wheels = [(wheel.origin_in_base, wheel.part) for wheel in self.wheels.values()]
        for part_in_base, part in [(IDENTITY, self.base), *wheels]:
            for collision in part.collisions:
                yield from transform_points(
                    part_in_base @ collision.pose_in_body, outline_points(collision.shape)
                )


class RobotStructure:
    """The link tree of a robot.

    Args:
        name: Name of the robot, for errors.
        links: The links.
        joints: The joints.

    Attributes:
        links: The links by name.
        joints: The joints by name.
        root: Name of the root link, whose frame is the base frame.

    Raises:
        RobotError: The links and joints are not one tree.
    """

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
        self._check_for_loops()

    def _check_for_loops(self) -> None:
        """Check that the chain of parents of each link ends at the root."""
        reached = {self.root}
        for link in self.links:
            chain: List[str] = []
            while link not in reached and link not in chain:
                chain.append(link)
                link = self._from_child[link].parent
            if link not in reached:
                joints = ", ".join(self._from_child[each].name for each in chain[chain.index(link) :])
                raise RobotError(f"robot {self.name}: these joints form a loop: {joints}")
            reached.update(chain)

    def pose_in_base(self, link: str) -> np.ndarray:
        """Return the pose (4, 4) of a link in the base frame with all joints at 0.

        Raises:
            RobotError: There is no such link.
        """
        if link not in self.links:
            raise RobotError(f"robot {self.name}: no link named {link!r}")
        in_base = IDENTITY
        while link != self.root:
            joint = self._from_child[link]
            in_base = joint.child_in_parent @ in_base
            link = joint.parent
        return in_base

    def assemble(self, driven: Iterable[str], friction: Mapping[str, float] = {}) -> RobotModel:
        """Return the rigid parts of the robot.

        Args:
            driven: Joints of the driven wheels; all other joints are treated as fixed.
            friction: Coefficients of friction of wheels, by the name of the link, that are not 1.

        Raises:
            RobotError: One of the joints does not exist, or a part has no mass.
        """
        wheel_joints = [self._joint(name) for name in driven]
        wheels = {
            joint.name: Wheel(
                self._part(joint.child, wheel_joints),
                self.pose_in_base(joint.child),
                joint.axis,
                friction.get(joint.child, 1.0),
            )
            for joint in wheel_joints
        }
        return RobotModel(self._part(self.root, wheel_joints), wheels)

    def _joint(self, name: str) -> RobotJoint:
        if name not in self.joints:
            raise RobotError(
                f"robot {self.name}: its drive names the joint {name!r}, which does not exist "
                f"(joints: {', '.join(self.joints) or 'none'})"
            )
        return self.joints[name]

    def _part(self, first: str, wheel_joints: Sequence[RobotJoint]) -> RigidPart:
        """Merge ``first`` with all links below it, up to the driven wheels."""
        fixed: List[Tuple[RobotLink, np.ndarray]] = [(self.links[first], IDENTITY)]
        for link, link_in_part in fixed:
            for joint in self._from_child.values():
                if joint.parent == link.name and joint not in wheel_joints:
                    fixed.append((self.links[joint.child], link_in_part @ joint.child_in_parent))
        return self._merged(fixed)

    def _merged(self, links: Sequence[Tuple[RobotLink, np.ndarray]]) -> RigidPart:
        """Merge links into one part; inertias are added by the parallel axis theorem."""
        name = links[0][0].name
        mass = sum(link.mass for link, _ in links)
        if mass <= 0.0:
            raise RobotError(f"robot {self.name}: link {name}: a moving part needs a mass")
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
    """Elements of a description that Gazebo reads.

    Attributes:
        root: The <robot> or <model>.
        plugins: <plugin> elements of the model.
        sensors: <sensor> elements, each with the name of its link.
        skipped: Warnings about elements without effect.
    """

    root: Element
    plugins: List[Element] = field(default_factory=list)
    sensors: List[Tuple[str, Element]] = field(default_factory=list)
    skipped: SkippedElements = field(default_factory=SkippedElements)

    def add(self, parent: Element, link: str) -> None:
        """Add the <plugin> and <sensor> children of an element.

        Args:
            parent: <gazebo> in URDF, <model> or <link> in SDF.
            link: Name of the link that the sensors are fixed to.
        """
        self.plugins.extend(parent.children("plugin"))
        self.sensors.extend((link, sensor) for sensor in parent.children("sensor"))
