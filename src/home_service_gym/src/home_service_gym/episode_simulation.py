"""A robot in an arena, moved by control periods, put back in well under a millisecond for each episode."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Sequence, Tuple

import numpy as np

from home_service_gym.traversable_space import TraversableSpace
from laboratory.worlds.source import Arena
from planar import Pose2, Scan, Twist2
from sim_bridge import RobotProfile, Simulation, SimulationSettings, StepResult
from sim_bridge.people.crowd import body_of
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.views.true_map import outlines_of, true_map
from sim_bridge.world import Body, World

# Metres over the floor up to which a robot meets what moves.
HEIGHT = 0.5


@dataclass(frozen=True, eq=False)
class EpisodeState:
    """The end of a control period; ``touched``: names of what the robot bumped into during it.

    ``base_in_world`` and ``people`` are the truth, ``base_in_odom`` and ``twist`` are what odometry tells.
    ``people`` (N, 5): x, y, velocity by x and y, m/s, radius of each.
    """

    stamp: float
    base_in_world: Pose2
    base_in_odom: Pose2
    twist: Twist2
    scan: Scan
    touched: Tuple[str, ...]
    people: np.ndarray

    def ranges(self, most: float, each: int = 1) -> np.ndarray:
        """What one beam of ``each`` tells, float32, from 0 to ``most`` m; np.clip takes thrice as long."""
        told = np.maximum(self.scan.ranges[::each], np.float32(0.0))
        return np.minimum(told, np.float32(most), out=told)


class EpisodeSimulation:
    """``rate``: control periods a second, in each of which the lidar and odometry tell once."""

    def __init__(
        self, arena: Arena, robot: RobotProfile, noise: SimulationSettings, start: Pose2, rate: int = 10
    ):
        self.arena, self.start = arena, start
        settings = replace(noise, odometry_rate=rate, scan_rate=rate)
        self._simulation = Simulation(arena.world, with_lidar_only(robot), settings, 0, start)
        self._simulation.mark()

    @cached_property
    def traversable_space(self) -> TraversableSpace:
        """Where there is room, by the truth about the arena as it is at the beginning."""
        static_bodies = [body for body in self.arena.world.bodies if body.is_static]
        world = replace(self.arena.world, bodies=tuple(static_bodies))
        grid = true_map(world, inside=(self.start.x, self.start.y))
        return TraversableSpace(grid, self.start, moving_discs(self.arena.world))

    def reset(self, seed: int, start: Pose2, trajectories: Sequence[ScriptedTrajectory] = ()) -> EpisodeState:
        """Begins an episode with the noise of a seed, and ``courses`` beside those of the world."""
        self._simulation.scene.trajectory_player.trajectories = (
            *self.arena.world.trajectories,
            *trajectories,
        )
        self._simulation.rewind(seed, start)
        return self.step(Twist2())

    def step(self, command: Twist2) -> EpisodeState:
        """Drives for a control period."""
        seen = self._simulation.step(command)
        return _state_of(seen, self._simulation.scene.crowd.rows)

    def trajectory_positions(self, trajectories: Sequence[ScriptedTrajectory], stamp: float) -> np.ndarray:
        """Where what goes its own way then is, (N, 2)."""
        return np.array([trajectory.at(stamp) for trajectory in trajectories]).reshape(-1, 2)

    def close(self) -> None:
        self._simulation.close()


def _state_of(seen: StepResult, people: np.ndarray) -> EpisodeState:
    assert seen.scan is not None, "a lidar tells once a period"
    told = seen.odometry
    pose, odom = seen.base_in_world, told.base_in_odom
    return EpisodeState(seen.stamp, pose, odom, told.twist, seen.scan, seen.contacts, people)


def moving_discs(world: World) -> np.ndarray:
    """What does not keep still, as it begins: x, y and radius of each part of it, (N, 3)."""
    begins = {trajectory.link: trajectory.at(0.0) for trajectory in world.trajectories}
    discs = [
        (*begins.get(body.name, middle), float(np.hypot(*(outline - middle).T).max()))
        for body in (*world.bodies, *map(body_of, world.walkers))
        if not body.is_static
        for middle in [body.pose_in_world[:2, 3].tolist()]
        for outline in outlines_of(static_world_of(world, body), 0.0, HEIGHT)
    ]
    return np.array(discs).reshape(-1, 3)


def static_world_of(world: World, body: Body) -> World:
    """With this body alone, which stands where it is."""
    return replace(world, bodies=(replace(body, is_kinematic=False),))


def with_lidar_only(robot: RobotProfile) -> RobotProfile:
    """The robot without the sensors that no environment observes, which would cost time."""
    return replace(robot, sensors=(lidar_profile(robot),))


def lidar_profile(robot: RobotProfile) -> LaserProfile:
    """Its first one; every robot that is known by name has one."""
    return next(spec for spec in robot.sensors if isinstance(spec, LaserProfile))
