"""A world with robots in it, stepped: what Gazebo's server is, without its connections."""

from dataclasses import dataclass, replace
from typing import Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from planar import Pose2, Twist2
from planar.config.hints import hint
from sim_bridge.config import SimulationSettings
from sim_bridge.description import RobotProfile
from sim_bridge.errors import UnknownEntityError, WorldError
from sim_bridge.geometry.pose3 import cross, from_pose2, inverse
from sim_bridge.physics.engine import Engine, JointState, MassProperties, Motion
from sim_bridge.robot import Observation, Robot
from sim_bridge.sensors.camera import Picture
from sim_bridge.sensors.imu import ImuReading
from sim_bridge.sensors.mounted import MountedSensors
from sim_bridge.views.drawing import Drawing
from sim_bridge.world import Body, Joint, World

# Metres above a robot's start from which on a floor is looked for.
FLOOR_SEARCH = 0.1
AT_REST = (np.zeros(3), np.zeros(3))


@dataclass(frozen=True, eq=False)
class Push:
    """A ``force``, N, at the centre of a link's mass, and a ``torque``, N m, from ``start`` to ``end``, s.

    Both (3,), along the axes of the world.
    """

    link: str
    force: np.ndarray
    torque: np.ndarray
    start: float
    end: float


@dataclass(frozen=True)
class JointPush:
    """An ``effort``, N m or N, on a joint from ``start`` to ``end``, s."""

    joint: str
    effort: float
    start: float
    end: float


class Scene:
    """Models that stand and move, robots that are commanded. The same seed and calls give the same results.

    A model is known by its name, its links by ``model::link``; a robot is a model. Methods that take a name
    raise UnknownEntityError if there is nothing of that name.
    """

    def __init__(self, world: World, settings: SimulationSettings = SimulationSettings(), seed: int = 0):
        self.settings = settings
        self.gravity = world.gravity
        self._seed = seed
        self._bodies: Dict[str, Body] = {}
        self._joints: Dict[str, Joint] = {}
        self._starts: Dict[str, Tuple[RobotProfile, np.ndarray]] = {}
        self._robots: Dict[str, Robot] = {}
        self._sensors: Dict[str, MountedSensors] = {}
        self.lights = {light.name: light for light in world.lights}
        self._pushes: List[Push] = []
        self._joint_pushes: List[JointPush] = []
        self._physics_steps = 0
        # In words, what cameras cannot see, known when they first look.
        self.unseen: Tuple[str, ...] = ()
        # Made when it is first looked at: meshes may take seconds.
        self._drawing: Optional[Drawing] = None
        # When the present rate of physics began.
        self._stamp_at_rate = 0.0
        self._engine = Engine(settings.physics_rate, world.gravity)
        self.add(world.bodies, world.joints)

    @property
    def stamp(self) -> float:
        """Simulated seconds since the start."""
        return self._stamp_at_rate + self._physics_steps / self.settings.physics_rate

    @property
    def step_seconds(self) -> float:
        """Simulated seconds that a step takes: the period of the odometry."""
        return 1.0 / self.settings.odometry_rate

    def step(self, commands: Mapping[str, Twist2] = {}) -> Dict[str, Observation]:
        """Moves on by one period of the odometry; a robot's last command holds until its time-out.

        Returns what each robot has observed.
        """
        for name, command in commands.items():
            self.robot(name).command(command)
        robots = self._robots.values()
        for _ in range(self.settings.physics_rate // self.settings.odometry_rate):
            for robot in robots:
                robot.begin_step()
            self._push()
            self._engine.step()
            self._physics_steps += 1
            for robot in robots:
                robot.end_step(self._physics_steps, self.stamp)
        return {robot.name: robot.observe(self.stamp) for robot in robots}

    def close(self) -> None:
        """Frees the physics engine."""
        self._engine.close()

    def add_robot(
        self, name: str, profile: RobotProfile, base_in_world: Pose2 = Pose2(), z: float = 0.0
    ) -> None:
        """Puts a robot on the floor at, or below, the height ``z``.

        Raises WorldError if it cannot stand there or the name is taken.
        """
        if name in self.model_names():
            raise WorldError(f"{name} is in the world already")
        floor = self._engine.floor_below(base_in_world.x, base_in_world.y, z + FLOOR_SEARCH)
        if floor is None:
            where = f"({base_in_world.x:g}, {base_in_world.y:g})"
            raise WorldError(f"the robot would start at {where}, where there is no floor")
        self._add_robot(name, profile, from_pose2(base_in_world, z=floor - profile.model.lowest))
        try:
            self._robots[name].vehicle.check_start()
        except WorldError:
            self.remove_model(name)
            raise

    def add(self, bodies: Sequence[Body], joints: Sequence[Joint] = ()) -> None:
        """Puts bodies into the world, held to each other by joints. Raises WorldError if a name is taken."""
        self._engine.add(bodies, joints)
        self._bodies.update((body.name, body) for body in bodies)
        self._joints.update((joint.name, joint) for joint in joints)
        for robot in self._robots.values():
            robot.look_at(bodies)
        self._draw(bodies)

    def remove_model(self, name: str) -> None:
        links = self.links_of(name)
        robot = self._robots.pop(name, None)
        self._sensors.pop(name, None)
        self._starts.pop(name, None)
        self._joints = {key: joint for key, joint in self._joints.items() if joint.model != name}
        for link in links[:1] if robot else links:
            if self._engine.has_link(link):
                self._engine.remove(link)
            self._bodies.pop(link, None)
            if self._drawing is not None:
                self._drawing.remove(link)
            for other in self._robots.values():
                other.lose_sight(link)

    def robot(self, name: str) -> Robot:
        return _found(self._robots, name, "robot")

    def drawing(self, but: str = "") -> Tuple[np.ndarray, np.ndarray]:
        """What cameras see: triangles (T, 3, 3) and their shades (T, 3), uint8; not the model ``but``."""
        if self._drawing is None:
            self._drawing = Drawing()
            self._draw([*self._bodies.values(), *(robot.body() for robot in self._robots.values())])
            self.unseen = tuple(self._drawing.warnings)
        return self._drawing.triangles(self._engine.pose_of, but)

    def picture(self, robot: str, number: int = 0) -> Picture:
        """What the camera of that number of a robot sees now; the robot itself is not in it."""
        pose = self._engine.pose_of(self.robot(robot).vehicle.base)
        return self._mounted(robot).picture(number, *self.drawing(but=robot), pose)

    def inertia(self, robot: str, number: int, seconds: float) -> ImuReading:
        """What a robot's inertial sensor of that number feels, ``seconds`` after it was last asked."""
        base, imu = self.robot(robot).vehicle.motion(), self.robot(robot).profile.imus[number]
        sensor = _seen_from(base, imu.pose_in_base)
        return self._mounted(robot).inertia(number, sensor, seconds, self.gravity)

    def model_names(self) -> List[str]:
        return list(dict.fromkeys([*(body.model for body in self._bodies.values()), *self._robots]))

    def links_of(self, model: str) -> List[str]:
        """The names of a model's links; the first is the one that its pose is told by."""
        if model in self._robots:
            return list(self._robots[model].vehicle.links)
        links = [body.name for body in self._bodies.values() if body.model == model]
        if not links:
            raise UnknownEntityError(_unknown("model", model, self.model_names()))
        return links

    def is_static(self, model: str) -> bool:
        """Whether nothing of a model can move."""
        return model not in self._robots and all(
            self._bodies[link].mass is None for link in self.links_of(model)
        )

    def model_motion(self, name: str) -> Motion:
        """Where a model's frame is and how it moves."""
        link = self.links_of(name)[0]
        motion = self._engine.motion_of(link)
        if link not in self._bodies:
            return motion
        return _seen_from(motion, inverse(self._bodies[link].pose_in_model))

    def full_link_name(self, name: str) -> str:
        """The name ``model::link`` of the first link that is called so, with its model or without."""
        known = [link for model in self.model_names() for link in self.links_of(model)]
        for link in known:
            if link == name or link.endswith("::" + name):
                return link
        raise UnknownEntityError(_unknown("link", name, known))

    def link_motion(self, link: str) -> Motion:
        model = link.split("::", 1)[0]
        if model not in self.model_names() or link not in self.links_of(model):
            links = [name for known in self.model_names() for name in self.links_of(known)]
            raise UnknownEntityError(_unknown("link", link, links))
        return self._engine.motion_of(link)

    def set_model_motion(self, name: str, motion: Motion) -> None:
        """Puts a model with all its links to another place, and sets its velocity."""
        from_here = motion.pose @ inverse(self.model_motion(name).pose)
        links = self.links_of(name)
        for link in links[:1] if name in self._robots else self._unheld(links):
            pose = from_here @ self._engine.pose_of(link)
            arm = pose[:3, 3] - motion.pose[:3, 3]
            self._set_motion(link, Motion(pose, motion.linear + cross(motion.angular, arm), motion.angular))
        if name in self._robots:
            self._robots[name].halt()

    def set_link_motion(self, link: str, motion: Motion) -> None:
        self.link_motion(link)
        self._set_motion(link, motion)

    def attach(self, first: str, second: str) -> None:
        """Holds two links together as they are now; they do not feel each other's touch then."""
        self.link_motion(first)
        self.link_motion(second)
        self._engine.attach(first, second)

    def detach(self, first: str, second: str) -> None:
        """Raises UnknownEntityError if these two are not attached in this order."""
        if not self._engine.is_attached(first, second):
            raise UnknownEntityError(f"{second} is not attached to {first}")
        self._engine.detach(first, second)

    def joint_names(self, model: str) -> List[str]:
        """The names of a model's joints that move, ``model::joint``."""
        return [
            joint.name for joint in self._joints.values() if joint.model == model and joint.kind != "fixed"
        ]

    def solids_of(self, model: str) -> List[str]:
        """The names of the collisions of a model."""
        bodies = (body for body in self._bodies.values() if body.model == model)
        return [part.name for body in bodies for part in body.collisions]

    def mass_properties(self, link: str) -> MassProperties:
        self.link_motion(link)
        return self._engine.mass_properties(link)

    def set_mass(self, link: str, mass: float, moments: Sequence[float], has_weight: bool) -> None:
        """``mass`` in kg, ``moments`` (3,) about the link's principal axes, kg m^2, and whether it falls."""
        self.link_motion(link)
        self._engine.set_mass(link, mass, moments, has_weight)

    def full_joint_name(self, name: str) -> str:
        """The name ``model::joint`` of the first joint that is called so, with its model or without."""
        for known in self._joints:
            if known == name or known.endswith("::" + name):
                return known
        raise UnknownEntityError(_unknown("joint", name, self._joints))

    def set_joint_limits(self, name: str, lower: float, upper: float, damping: float) -> None:
        """Limits in rad or m, ``damping`` in N m s/rad or N s/m; a joint that is fixed stays so."""
        self._joints[name] = replace(self.joint(name), lower=lower, upper=upper, damping=damping)
        if self._joints[name].kind != "fixed":
            self._engine.set_joint_limits(name, lower, upper, damping)

    def joint(self, name: str) -> Joint:
        return _found(self._joints, name, "joint")

    def joint_state(self, name: str) -> JointState:
        """Of a joint that moves."""
        return self._engine.joint_state(self.joint(name).name)

    def set_joints(self, positions: Mapping[str, float]) -> None:
        """Puts joints to positions, rad or m, at rest; those that are fixed stay so."""
        for name, position in positions.items():
            if self.joint(name).kind != "fixed":
                self._engine.set_joint(name, JointState(position, 0.0))

    def push_joint(self, push: JointPush) -> None:
        """Applies an effort to a joint for a while."""
        self.joint(push.joint)
        self._joint_pushes.append(push)

    def stop_pushing_joint(self, joint: str) -> None:
        """Ends all efforts on a joint."""
        self._joint_pushes = [push for push in self._joint_pushes if push.joint != joint]

    def push(self, push: Push) -> None:
        """Applies a force and torque for a while."""
        self.link_motion(push.link)
        self._pushes.append(push)

    def stop_pushing(self, link: str) -> None:
        """Ends all pushes on a link."""
        self._pushes = [push for push in self._pushes if push.link != link]

    def set_gravity(self, gravity: float) -> None:
        """``gravity``: downwards, m/s^2."""
        self.gravity = gravity
        self._engine.set_gravity(gravity)

    def set_physics_rate(self, rate: int) -> None:
        """``rate``: steps of physics a second. Raises SettingsError if another rate is no divisor of it."""
        settings = replace(self.settings, physics_rate=rate)
        self._stamp_at_rate, self._physics_steps = self.stamp, 0
        self.settings = settings
        self._engine.set_rate(rate)
        for robot in self._robots.values():
            robot.settings = settings

    def reset_poses(self) -> None:
        """Puts every model and robot back to where it was first put, at rest. Time and odometry go on."""
        self._engine.detach_all()
        self.set_joints({joint.name: joint.start for joint in self._joints.values()})
        for name in self._unheld(self._bodies):
            self._set_motion(name, Motion(self._bodies[name].pose_in_world, *AT_REST))
        for name, (_, base_in_space) in self._starts.items():
            robot = self._robots[name]
            self._set_motion(robot.vehicle.base, Motion(base_in_space, *AT_REST))
            robot.halt()
        self._pushes.clear()
        self._joint_pushes.clear()

    def reset(self) -> None:
        """Starts again at time 0, with all models and robots where they were first put, to the same noise."""
        starts, bodies, joints = self._starts, list(self._bodies.values()), list(self._joints.values())
        self._engine.close()
        self._engine = Engine(self.settings.physics_rate, self.gravity)
        self._starts, self._bodies, self._joints, self._robots, self._sensors = {}, {}, {}, {}, {}
        self._pushes.clear()
        self._joint_pushes.clear()
        self._physics_steps, self._stamp_at_rate, self._drawing = 0, 0.0, None
        self.add(bodies, joints)
        for name, (profile, base_in_space) in starts.items():
            self._add_robot(name, profile, base_in_space)

    def _add_robot(self, name: str, profile: RobotProfile, base_in_space: np.ndarray) -> None:
        index = len(self._robots)
        seed = [self._seed] if index == 0 else [self._seed, index]
        robot = Robot(self._engine, name, profile, base_in_space, self.settings, seed)
        robot.look_at(self._bodies.values())
        for other in self._robots.values():
            other.look_at([robot.body()])
            robot.look_at([other.body()])
        self._robots[name] = robot
        self._draw([robot.body()])
        self._starts[name] = (profile, base_in_space)

    def _mounted(self, robot: str) -> MountedSensors:
        """Cameras and inertial sensors of a robot, made when they are first asked."""
        if robot not in self._sensors:
            seed = [self._seed, list(self._robots).index(robot)]
            self._sensors[robot] = MountedSensors(self.robot(robot).profile, self.settings, seed)
        return self._sensors[robot]

    def _draw(self, bodies: Sequence[Body]) -> None:
        if self._drawing is not None:
            for body in bodies:
                self._drawing.add(body)

    def _set_motion(self, link: str, motion: Motion) -> None:
        self._engine.set_motion(link, motion)
        if self._drawing is not None:
            self._drawing.move(link, motion.pose)
        for robot in self._robots.values():
            robot.see_moved(link, motion.pose)

    def _push(self) -> None:
        for push in self._pushes:
            if push.start <= self.stamp < push.end:
                self._engine.push(push.link, push.force.tolist(), push.torque.tolist())
        for effort in self._joint_pushes:
            if effort.start <= self.stamp < effort.end:
                self._engine.push_joint(effort.joint, effort.effort)
        self._pushes = [push for push in self._pushes if self.stamp < push.end]
        self._joint_pushes = [effort for effort in self._joint_pushes if self.stamp < effort.end]

    def _unheld(self, links: Iterable[str]) -> List[str]:
        """Those links that no joint holds to another: what hangs on them moves with them."""
        held = {joint.child for joint in self._joints.values() if joint.parent}
        return [link for link in links if link not in held]


def _seen_from(motion: Motion, offset: np.ndarray) -> Motion:
    """The motion of a frame that is fixed at ``offset`` (4, 4) in a moving one."""
    pose = motion.pose @ offset
    arm = pose[:3, 3] - motion.pose[:3, 3]
    return Motion(pose, motion.linear + cross(motion.angular, arm), motion.angular)


def _found(table: Mapping, name: str, kind: str):
    if name not in table:
        raise UnknownEntityError(_unknown(kind, name, table))
    return table[name]


def _unknown(kind: str, name: str, known) -> str:
    return f"no {kind} named {name!r}{hint(name, known)}"
