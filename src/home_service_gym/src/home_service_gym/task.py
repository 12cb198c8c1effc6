"""The contract of a task: what a robot is to do, what it is told of that, and what it is worth."""

import math
from dataclasses import dataclass, field
from typing import Any, Dict, Optional, Protocol, Sequence, Tuple

import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from planar import Pose2
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import Body

# What the tasks here have in common: of a metre nearer to the goal, of a control period, of the ends.
PROGRESS_REWARD, PERIOD_REWARD, SUCCESS_REWARD, COLLISION_REWARD = 1.0, -0.01, 10.0, -10.0


@dataclass(frozen=True, eq=False)
class EpisodeStart:
    """Where the robot starts, and the courses of bodies that the task has brought along."""

    start: Pose2
    trajectories: Sequence[ScriptedTrajectory] = ()


@dataclass(frozen=True)
class TaskStep:
    """What a control period was worth; ``outcome``: why the episode ends with it, empty if it does not."""

    reward: float
    outcome: str = ""


@dataclass(frozen=True, eq=False)
class Overlay:
    """For pictures: a ``goal`` and its radius, ``courses`` of what moves, ``known`` cells of the ground."""

    goal: Optional[Tuple[Pose2, float]] = None
    trajectories: Sequence[ScriptedTrajectory] = field(default_factory=tuple)
    explored: Optional[np.ndarray] = None


class EpisodeTask(Protocol):
    """Chance comes from ``rng`` alone; the same calls give the same results."""

    def bodies(self) -> Sequence[Body]:
        """What it brings along into every arena."""

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        """Of what it tells beside ``scan`` and ``velocity``."""

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        """A new episode. Raises PlanarError if this arena does not do."""

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        """What it tells; called once at the beginning, and after each ``judge``."""

    def step(self, state: EpisodeState) -> TaskStep:
        """The control period that ends with this moment; a collision is judged by the environment."""

    def overlay(self) -> Overlay:
        """What pictures show of it."""


def goal_space() -> spaces.Box:
    """Distance, m, cosine and sine of the bearing."""
    low, high = np.array([0.0, -1.0, -1.0], np.float32), np.array([MAX_GOAL_DISTANCE, 1.0, 1.0], np.float32)
    return spaces.Box(low, high, dtype=np.float32)


MAX_GOAL_DISTANCE = 100.0


def goal_observation(base: Pose2, goal: Pose2) -> np.ndarray:
    """A goal as ``goal_space`` has it."""
    x, y = goal.x - base.x, goal.y - base.y
    bearing = math.atan2(y, x) - base.yaw
    distance = min(math.hypot(x, y), MAX_GOAL_DISTANCE)
    return np.array((distance, math.cos(bearing), math.sin(bearing)), dtype=np.float32)
