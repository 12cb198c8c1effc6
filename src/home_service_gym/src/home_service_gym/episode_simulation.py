"""Simulation of one world, stepped by control periods and reset within a millisecond."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Sequence, Tuple

import numpy as np

from home_service_gym.traversable_space import TraversableSpace
from laboratory.worlds.source import Arena
from planar import Pose2, Scan, Twist2
from sim_bridge import Episode, RobotProfile, Simulation, SimulationSettings, StepResult
from sim_bridge.people.crowd import body_of
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.views.true_map import outlines_of, true_map
from sim_bridge.world import Body, World

# Height up to which moving bodies count as obstacles [m].
HEIGHT = 0.5


@dataclass(frozen=True, eq=False)
class EpisodeState:
    """State at the end of a control period.

    Attributes:
        stamp: Simulated time [s].
        base_in_world: True pose of the robot.
        base_in_odom: Pose of the robot by odometry.
        twist: Velocity by odometry.
        scan: Latest scan.
        touched: Names of the bodies the robot collided with during the period.
        people: (N, 5) true x, y, velocity in x and y [m/s], radius of each pedestrian.
    """

    stamp: float
    base_in_world: Pose2
    base_in_odom: Pose2
    twist: Twist2
    scan: Scan
    touched: Tuple[str, ...]
    people: np.ndarray

    def ranges(self, most: float, each: int = 1) -> np.ndarray:
        """Return every ``each``-th range as float32, clipped to [0, ``most``] (np.clip is slower)."""
        ranges = np.maximum(self.scan.ranges[::each], np.float32(0.0))
        return np.minimum(ranges, np.float32(most), out=ranges)


class EpisodeSimulation:
    """Simulation of one robot in one world.

    Args:
        arena: World to simulate.
        robot: Robot profile; only its lidar and odometry are simulated.
        noise: Noise of the sensors and the drive.
        start: Start pose in the world frame.
        rate: Control rate [Hz], also that of scans and odometry.
    """

    def __init__(
        self, arena: Arena, robot: RobotProfile, noise: SimulationSettings, start: Pose2, rate: int = 10
    ):
        self.arena, self.start = arena, start
        settings = replace(noise, odometry_rate=rate, scan_rate=rate)
        self._simulation = Simulation(arena.world, with_lidar_only(robot), settings, 0, start)
        self._episode = Episode(self._simulation, self._simulation.step_seconds)
        self._simulation.mark()

    @cached_property
    def traversable_space(self) -> TraversableSpace:
        """Traversable space of the true map at the start."""
        static_bodies = [body for body in self.arena.world.bodies if body.is_static]
        world = replace(self.arena.world, bodies=tuple(static_bodies))
        grid = true_map(world, inside=(self.start.x, self.start.y))
        return TraversableSpace(grid, self.start, moving_discs(self.arena.world))

    def reset(self, seed: int, start: Pose2, trajectories: Sequence[ScriptedTrajectory] = ()) -> EpisodeState:
        """Start an episode.

        Args:
            seed: Seed of the noise.
            start: Start pose in the world frame.
            trajectories: Scripted trajectories in addition to those of the world.
        """
        self._simulation.scene.trajectory_player.trajectories = (
            *self.arena.world.trajectories,
            *trajectories,
        )
        self._simulation.rewind(seed, start)
        return self.step(Twist2())

    def step(self, command: Twist2) -> EpisodeState:
        """Drive for one control period."""
        step = self._episode.step(command)
        return _state_of(step, self._simulation.scene.crowd.rows)

    def close(self) -> None:
        self._simulation.close()


def _state_of(step: StepResult, people: np.ndarray) -> EpisodeState:
    assert step.scan is not None, "the lidar measures once each period"
    odometry = step.odometry
    return EpisodeState(
        step.stamp,
        step.base_in_world,
        odometry.base_in_odom,
        odometry.twist,
        step.scan,
        step.contacts,
        people,
    )


def moving_discs(world: World) -> np.ndarray:
    """Return x, y and radius (N, 3) of all moving bodies at the start."""
    starts = {trajectory.link: trajectory.at(0.0) for trajectory in world.trajectories}
    discs = [
        (*starts.get(body.name, middle), float(np.hypot(*(outline - middle).T).max()))
        for body in (*world.bodies, *map(body_of, world.walkers))
        if not body.is_static
        for middle in [body.pose_in_world[:2, 3].tolist()]
        for outline in outlines_of(static_world_of(world, body), 0.0, HEIGHT)
    ]
    return np.array(discs).reshape(-1, 3)


def static_world_of(world: World, body: Body) -> World:
    """Return a world with only this body, as a static one."""
    return replace(world, bodies=(replace(body, is_kinematic=False),))


def with_lidar_only(robot: RobotProfile) -> RobotProfile:
    """Return the robot without sensors that no environment observes, which would cost time."""
    return replace(robot, sensors=(lidar_profile(robot),))


def lidar_profile(robot: RobotProfile) -> LaserProfile:
    """Return the profile of its first lidar; every included robot has one."""
    return next(spec for spec in robot.sensors if isinstance(spec, LaserProfile))
