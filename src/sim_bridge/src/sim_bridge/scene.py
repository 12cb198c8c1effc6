"""A simulated world with any number of robots: what Gazebo's server is, without its ROS interface."""

import math
from dataclasses import replace
from functools import reduce
from typing import Dict, Iterable, Mapping, Sequence, Tuple

import numpy as np

from planar import Pose2, Twist2
from planar.config.hints import hint
from sim_bridge.config import SimulationSettings
from sim_bridge.description import RobotProfile
from sim_bridge.doors import DOOR_RATE, Doors
from sim_bridge.driving.parking import Parking
from sim_bridge.errors import UnknownEntityError, WorldError
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.people.crowd import WALK_RATE, Crowd, rows_of
from sim_bridge.physics.engine import Engine
from sim_bridge.physics.forces import Forces
from sim_bridge.physics.kinematics import KinematicState, Steps, at_rest, interval
from sim_bridge.physics.model_joints import ModelJoints
from sim_bridge.physics.models import Models
from sim_bridge.physics.vehicle import Overlap
from sim_bridge.robot import Robot, RobotWrappers, StepResult
from sim_bridge.scripted_trajectories import TRAJECTORY_RATE, ScheduledMoves, TrajectoryPlayer
from sim_bridge.sensors.base import Mounting
from sim_bridge.views.scene_view import SceneView
from sim_bridge.world import Body, Joint, World

# Height above a robot's start from which a floor is searched downwards [m].
FLOOR_SEARCH = 0.1
# Distance [m] and number of moves by which a robot that would start inside an obstacle is moved at most.
MAX_START_SHIFT, MAX_START_MOVES = 0.15, 10
# Rates at which scripted bodies move [Hz].
MOVING_RATES = (TRAJECTORY_RATE, WALK_RATE, DOOR_RATE)
# Simulated time for which they are moved at once while the scene is parked [s].
MOVED_AT_ONCE = 600


class Scene:
    """A world that is stepped, with its robots. The same seed and calls give the same results, bit for bit.

    Methods that take the name of a model, link or robot raise UnknownEntityError if there is none.

    Args:
        world: The world.
        settings: Rates and noise.
        seed: Seed of all noise.
        wrappers: Wrap the sensors and drives of the robots.

    Attributes:
        models: Poses, velocities and masses of models and links.
        joints: Joints of the models.
        forces: Wrenches and efforts that act for a given time.
        view: What sensors see of the scene.
        lights: Lights by name.
        trajectory_player: Moves bodies along scripted trajectories.
        moves: Models that are moved at given times.
        crowd: Pedestrians.
        doors: Doors.
    """

    _parking: Parking
    _physics_steps: int

    def __init__(
        self,
        world: World,
        settings: SimulationSettings = SimulationSettings(),
        seed: int = 0,
        wrappers: RobotWrappers = RobotWrappers(),
    ):
        self.lights = {light.name: light for light in world.lights}
        self.settings, self._seed, self._wrappers = settings, seed, wrappers
        self.trajectory_player, self.doors = TrajectoryPlayer(world.trajectories), Doors(world.doors)
        self.moves, self.crowd = ScheduledMoves(world.moves), Crowd(world.walkers, world)
        self._reset_engine(world.gravity)
        self.add([*world.bodies, *self.crowd.bodies, *self.doors.bodies], world.joints)

    @property
    def stamp(self) -> float:
        """Simulated time since the start [s]."""
        return self._stamp_at_rate + self._physics_steps / self.settings.physics_rate

    @property
    def step_seconds(self) -> float:
        """Simulated duration of a step [s]: the period of the odometry."""
        return 1.0 / self.settings.odometry_rate

    @property
    def gravity(self) -> float:
        """Downward acceleration [m/s^2]."""
        return self._engine.gravity

    def step(self, commands: Mapping[str, Twist2] = {}) -> Dict[str, StepResult]:
        """Advance the simulation by one period of the odometry.

        Args:
            commands: Velocity commands by robot; each holds until the drive's time-out.

        Returns:
            Sensor readings and ground truth of each robot at the end of the step.
        """
        for name, command in commands.items():
            self.wake()
            self.robot(name).command(command)
        if not self._parking.is_active and self.moves.is_due(self.stamp):
            self.moves.update(self.stamp, rows_of(self._robots.values())[:, :2], self.models.move_level)
        robots, stamp, has_forces = self._robots.values(), self.stamp, self.forces.are_pending
        rate, steps = self.settings.physics_rate, 1 if has_forces else _steps_at_once(self.settings, robots)
        for _ in range(rate // self.settings.odometry_rate // steps):
            self._move_bodies(steps)
            if not self._parking.is_active:
                for robot in robots:
                    robot.begin_steps(self._physics_steps)
                if has_forces:
                    self.forces.apply(stamp)
                self._engine.step(steps)
            self._physics_steps += steps
            stamp = self.stamp
            for robot in robots:
                robot.end_steps(self._physics_steps, stamp)
        return {robot.name: robot.observe(stamp) for robot in robots}

    def park(self) -> bool:
        """Stop physics until ``wake`` or a command, if robots have stood for a while and nothing moves.

        Meanwhile time, batteries, pedestrians and doors advance, and sensors measure what they do not move.

        Returns:
            Whether physics is stopped.
        """
        return self._parking.begin()

    def skip(self, count: int) -> None:
        """Advance a parked scene by periods of the odometry in which no sensor measures.

        Once it wakes, it is the same as if it had been stepped, to the last bit.

        Args:
            count: Number of periods.
        """
        assert self._parking.is_active, "only a parked scene can skip steps"
        rate = self.settings.physics_rate
        end = self._physics_steps + count * (rate // self.settings.odometry_rate)
        while self._physics_steps < end:
            part = min(end, self._physics_steps + MOVED_AT_ONCE * rate)
            self._move_bodies(part - self._physics_steps)
            while self._physics_steps < part:
                self._physics_steps = self._parking.next_step(self._physics_steps, part)
                for robot in self._robots.values():
                    robot.update_power(self._physics_steps, self.stamp)

    def wake(self) -> None:
        """Let physics go on after ``park``; the noise of sensors starts afresh."""
        self._parking.end(self._physics_steps)

    def _move_bodies(self, count: int) -> None:
        """Move what is scripted before the next ``count`` steps: obstacles on trajectories, people, doors."""
        if self.trajectory_player.trajectories or self.crowd.links or self.doors.bodies:
            first, robots = self._physics_steps, self._robots.values()
            steps = Steps(first, first + count, self.settings.physics_rate, self._stamp_at_rate)
            self.trajectory_player.update(self._engine, steps)
            self.crowd.update(self._engine, steps, robots)
            self.doors.update(self._engine, steps, robots, self.crowd)

    def close(self) -> None:
        """Free the physics engine."""
        self._engine.close()

    def add_robot(
        self, name: str, profile: RobotProfile, base_in_world: Pose2 = Pose2(), z: float = 0.0
    ) -> Tuple[str, ...]:
        """Put a robot on the floor.

        A robot that would slightly overlap an obstacle is moved out of it, as contact forces do in Gazebo.

        Args:
            name: Name of the robot's model.
            profile: Parts, drive and sensors.
            base_in_world: Start pose of the base.
            z: Height at or below which the floor is searched [m].

        Returns:
            Names of the links that the robot was moved out of.

        Raises:
            WorldError: The robot cannot stand there, or the name is taken.
        """
        self.models.check_free([name])
        where = f"({base_in_world.x:g}, {base_in_world.y:g})"
        floor = self._engine.collision_queries.floor_below(base_in_world.x, base_in_world.y, z + FLOOR_SEARCH)
        if floor is None:
            raise WorldError(f"the robot would start at {where}, where there is no floor")
        start, resolved = base_in_world, Overlap((), 0.0, 0.0)
        for _ in range(MAX_START_MOVES):
            self._add_robot(name, profile, from_pose2(start, z=floor - profile.model.lowest))
            overlap = self._robots[name].vehicle.overlap()
            if overlap is None:
                return resolved.links
            self.remove_model(name)
            resolved, start = overlap, Pose2(start.x + overlap.x, start.y + overlap.y, start.yaw)
            if start.distance_to(base_in_world) > MAX_START_SHIFT:
                break
        raise WorldError(f"the robot would start at {where}, inside {', '.join(resolved.links)}")

    def robot(self, name: str) -> Robot:
        """Return a robot by the name of its model."""
        if name not in self._robots:
            raise UnknownEntityError(f"no robot named {name!r}{hint(name, self._robots)}")
        return self._robots[name]

    def add(self, bodies: Sequence[Body], joints: Sequence[Joint] = ()) -> None:
        """Add models.

        Args:
            bodies: The links of the models.
            joints: Joints between these links, or to the world.

        Raises:
            WorldError: A name is taken.
        """
        self.models.check_free(body.model for body in bodies)
        self._engine.add(bodies, joints)
        self.joints.add(joints)
        self.models.add(bodies)

    def remove_model(self, name: str) -> None:
        """Remove a model or robot."""
        for link in self.models.remove(name):
            self.forces.clear_link_wrenches(link)
        for joint in self.joints.remove_model(name):
            self.forces.clear_joint_efforts(joint)
        self._robots.pop(name, None)
        self._starts.pop(name, None)

    def set_model_state(self, name: str, state: KinematicState) -> None:
        """Set the pose and velocity of a model with all its links; a robot discards its command.

        Args:
            name: Name of the model.
            state: Pose and velocity of the model's frame in the world.
        """
        self.models.set_state(name, state)
        if name in self._robots:
            self._robots[name].halt()

    def attach(self, first: str, second: str) -> None:
        """Fix two links to each other in their present relative pose; they do not collide while attached.

        Args:
            first: Name of the holding link, ``model::link``, e.g. of a gripper.
            second: Name of the held link.
        """
        self.models.check_link(first)
        self.models.check_link(second)
        self._engine.attachments.attach(first, second)

    def detach(self, first: str, second: str) -> None:
        """Undo ``attach``.

        Args:
            first: Name of the holding link.
            second: Name of the held link.

        Raises:
            UnknownEntityError: The two are not attached in this order.
        """
        if not self._engine.attachments.are_attached(first, second):
            raise UnknownEntityError(f"{second} is not attached to {first}")
        self._engine.attachments.detach(first, second)

    def set_gravity(self, gravity: float) -> None:
        """Set the downward acceleration [m/s^2]."""
        self._engine.set_gravity(gravity)

    def set_physics_rate(self, rate: int) -> None:
        """Set the physics steps per second.

        Args:
            rate: Steps per simulated second [Hz].

        Raises:
            SettingsError: Another rate does not divide it.
        """
        settings = replace(self.settings, physics_rate=rate)
        self._stamp_at_rate, self._physics_steps = self.stamp, 0
        self.settings = settings
        self._engine.set_rate(rate)
        for robot in self._robots.values():
            robot.retime(settings)

    def reset_poses(self) -> None:
        """Move all models and robots back to their start poses, at rest; time and odometry continue."""
        self._engine.attachments.detach_all()
        self.joints.reset_positions()
        self.models.reset_poses()
        for name, (_, base_in_space) in self._starts.items():
            self.models.set_link_state(self._robots[name].vehicle.base, at_rest(base_in_space))
            self._robots[name].halt()
        self.forces.clear()

    def reset(self) -> None:
        """Restart at time 0 with the present models and robots at their start poses and the same noise."""
        starts, bodies, joints = self._starts, self.models.bodies(), self.joints.all()
        self._engine.close()
        self._reset_engine(self.gravity)
        self.add(bodies, joints)
        for name, (profile, base_in_space) in starts.items():
            self._add_robot(name, profile, base_in_space)

    def mark(self) -> None:
        """Save the present state, with the robots at rest, for ``rewind``."""
        self._marked_state = self._engine.save_state()

    def rewind(self, seed: int, starts: Mapping[str, Pose2] = {}) -> None:
        """Restart at time 0 from the marked state; much faster than ``reset``.

        The same seed, starts and calls give the same results. No model may have been added or removed since
        the mark.

        Args:
            seed: Seed of all noise from now on.
            starts: Start poses of robots, by name, that differ from the marked ones. They must be free and on
                the same floor.
        """
        self._engine.restore_state(self._marked_state)
        self._parking.end(0)
        self._seed, self._stamp_at_rate, self._physics_steps = seed, 0.0, 0
        self.forces.clear()
        for number, (name, robot) in enumerate(self._robots.items()):
            _, base_in_space = self._starts[name]
            if name in starts:
                base_in_space = from_pose2(starts[name], z=float(base_in_space[2, 3]))
                self.models.set_state(name, at_rest(base_in_space))
            robot.reset(Mounting(base_in_space, self.settings, seed, number))
        self.view.update()

    def _reset_engine(self, gravity: float) -> None:
        """Create an engine without bodies, at time 0."""
        # Steps at the present physics rate, and the time at which it was set.
        self._physics_steps, self._stamp_at_rate = 0, 0.0
        self._engine = Engine(self.settings.physics_rate, gravity)
        self.view = SceneView(self._engine.pose_of)
        self.joints = ModelJoints(self._engine)
        self.models = Models(self._engine, self.joints, self.view)
        self.forces = Forces(self._engine, self.models, self.joints)
        self._robots: Dict[str, Robot] = {}
        self._starts: Dict[str, Tuple[RobotProfile, np.ndarray]] = {}
        self._marked_state = -1
        self._parking = Parking(self._engine, self._robots, self.forces)

    def _add_robot(self, name: str, profile: RobotProfile, base_in_space: np.ndarray) -> None:
        mounting = Mounting(base_in_space, self.settings, self._seed, robot=len(self._robots))
        robot = Robot(self._engine, self.view, name, profile, mounting, self._wrappers)
        self._robots[name], self._starts[name] = robot, (profile, base_in_space)
        self.models.add_vehicle(robot.vehicle)


def _steps_at_once(settings: SimulationSettings, robots: Iterable[Robot]) -> int:
    """Return the number of physics steps between which nothing else has to be done.

    It is a power of two: Bullet divides the time step by it, and rounding would make it skip steps.
    """
    rate = settings.physics_rate
    actions = [interval(rate, times) for times in MOVING_RATES]
    largest = reduce(
        math.gcd, [*actions, *(robot.steps_at_once for robot in robots)], rate // settings.odometry_rate
    )
    return largest & -largest
