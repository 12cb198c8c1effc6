"""Contract of an environment's task: observations, rewards and termination."""

import math
from dataclasses import dataclass, field
from typing import Any, Dict, Optional, Protocol, Sequence, Tuple

import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from planar import Pose2
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import Body

# Reward terms: for each metre of progress to the goal, for each control period, for success and collision.
PROGRESS_REWARD, PERIOD_REWARD, SUCCESS_REWARD, COLLISION_REWARD = 1.0, -0.01, 10.0, -10.0


@dataclass(frozen=True, eq=False)
class EpisodeStart:
    """Initial state of an episode.

    Attributes:
        start: Start pose of the robot in the world frame.
        trajectories: Scripted trajectories of the task's own bodies.
    """

    start: Pose2
    trajectories: Sequence[ScriptedTrajectory] = ()


@dataclass(frozen=True)
class TaskStep:
    """Reward of a control period.

    Attributes:
        reward: The reward.
        outcome: Why the episode terminates; empty if it continues.
    """

    reward: float
    outcome: str = ""


@dataclass(frozen=True, eq=False)
class Overlay:
    """What a task adds to rendered images.

    Attributes:
        goal: Goal pose and its radius [m].
        trajectories: Scripted trajectories of moving bodies.
        explored: Explored cells of the map, bool (rows, cols).
    """

    goal: Optional[Tuple[Pose2, float]] = None
    trajectories: Sequence[ScriptedTrajectory] = field(default_factory=tuple)
    explored: Optional[np.ndarray] = None


class EpisodeTask(Protocol):
    """A task. All random numbers come from ``rng``; equal calls give equal results."""

    def bodies(self) -> Sequence[Body]:
        """Return bodies to add to every world."""

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        """Return the spaces of its observations, in addition to ``scan`` and ``velocity``."""

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        """Start an episode. Raises PlanarError if the world is not suitable."""

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        """Return its observations; called once after ``reset`` and after each ``step``."""

    def step(self, state: EpisodeState) -> TaskStep:
        """Rate the control period that ends with this state; the environment handles collisions."""

    def overlay(self) -> Overlay:
        """Return what rendered images show of the task."""


def goal_space() -> spaces.Box:
    """Return the space of a goal: distance [m], cosine and sine of the bearing."""
    low, high = np.array([0.0, -1.0, -1.0], np.float32), np.array([MAX_GOAL_DISTANCE, 1.0, 1.0], np.float32)
    return spaces.Box(low, high, dtype=np.float32)


MAX_GOAL_DISTANCE = 100.0


def goal_observation(base: Pose2, goal: Pose2) -> np.ndarray:
    """Return a goal as an element of ``goal_space``."""
    x, y = goal.x - base.x, goal.y - base.y
    bearing = math.atan2(y, x) - base.yaw
    distance = min(math.hypot(x, y), MAX_GOAL_DISTANCE)
    return np.array((distance, math.cos(bearing), math.sin(bearing)), dtype=np.float32)
