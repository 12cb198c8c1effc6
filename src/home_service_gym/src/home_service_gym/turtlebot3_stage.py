"""The stages of ROBOTIS' machine-learning tutorial (turtlebot3_machine_learning)."""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Dict, Optional, Tuple

import gymnasium
import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from home_service_gym.rendering import MODES, EpisodeRenderer
from home_service_gym.task import Overlay
from laboratory.suites import ROOT
from laboratory.worlds.source import Arena
from planar import Pose2, SettingsError, Twist2, wrap
from sim_bridge import SimulationSettings, load_world, robot_named
from sim_bridge.scripted_trajectories import ScriptedTrajectory

FOLDER = ROOT / "src/compat/turtlebot3_gazebo"
# Control rate [Hz], observed beams, speed [m/s] and maximum turn rate [rad/s].
RATE, BEAMS, SPEED, TURN = 5, 24, 0.15, 1.5
# Metres: range that counts as a collision, radius of the goal, range below which a penalty applies.
COLLISION_DISTANCE, GOAL_RADIUS, NEAR_DISTANCE = 0.13, 0.2, 0.5
# Goals of the first three stages [m], and of the fourth.
HALF, TENTHS, POST_CLEARANCE = 1.2, 10.0, 0.4
POSTS_XY = ((0.0, 0.0), (0.6, 0.6), (0.6, -0.6), (-0.6, 0.6), (-0.6, -0.6))
GOALS_XY = (
    *((0.6, 0.0), (1.9, -0.5), (0.5, -1.9), (0.2, 1.5), (-0.8, -0.9), (-1.0, 1.0), (-1.9, 1.1)),
    *((0.5, -1.5), (2.0, 1.5), (0.5, 1.8), (0.0, -1.0), (-0.1, 1.6), (-2.0, -0.8)),
)
# Period of the circling posts of stage 3 [s], and corners of their circles.
CIRCLE_SECONDS, CORNERS = 40.0, 48
# Keyframes of the walkers of stage 4: time [s], displacement [m].
WALKER_KEYFRAMES = {
    "obstacle_1": (
        *((0, 0.0, 0.0), (10, -0.5, -1.0), (50, -3.5, -1.0), (70, -3.7, -3.0), (90, -3.5, -1.0)),
        *((130, -0.5, -1.0), (140, 0.0, 0.0), (160, 0.0, 0.0)),
    ),
    "obstacle_2": (
        *((0, 0.0, 0.0), (10, 0.7, 0.2), (40, 2.5, 3.5), (55, 0.3, 3.5), (85, 3.5, 1.8), (100, 3.5, 0.0)),
        *((110, 2.0, 0.5), (115, 1.5, 1.0), (120, 1.0, 0.5), (125, 0.5, 0.1), (130, 0.0, 0.0)),
        (140, 0.0, 0.0),
    ),
}


@dataclass(frozen=True)
class StageRewards:
    """Rewards for reaching a goal, for a collision, and for a period close to an obstacle."""

    goal: float
    collision: float
    near: float


EASY, HARD = StageRewards(200.0, -200.0, 0.0), StageRewards(1000.0, -500.0, -5.0)
STARTS = {1: Pose2(), 2: Pose2(), 3: Pose2(), 4: Pose2(-0.7, 0.0)}


class TurtleBot3StageEnv(gymnasium.Env):
    """A stage of the tutorial with its observations, actions and rewards.

    The observation has 24 ranges [m], bearing [rad] and distance [m] of the goal and, except in stage 1, the
    shortest range and its index. The five actions turn from left to right at constant speed. A reached goal
    is replaced by another; the episode terminates with a collision.

    Args:
        stage: 1: an empty square, 2: four posts, 3: circling posts, 4: walls and two walkers.
        render_mode: ``rgb_array``, ``human`` or None.
    """

    metadata = {"render_modes": MODES, "render_fps": RATE}

    def __init__(self, stage: int = 1, render_mode: Optional[str] = None):
        if stage not in STARTS:
            raise SettingsError(f"stage must be 1, 2, 3 or 4, got {stage!r}")
        self.render_mode, self._stage = render_mode, stage
        self._rewards = EASY if stage == 1 else HARD
        robot, start = robot_named("turtlebot3_burger"), STARTS[stage]
        self._renderer = EpisodeRenderer(render_mode, robot, RATE)
        self._simulation = EpisodeSimulation(arena_of(stage), robot, SimulationSettings(), start, RATE)
        self._state: Optional[EpisodeState] = None
        farthest = [3.5] * BEAMS + [math.pi, 10.0] + ([3.5, BEAMS - 1.0] if stage > 1 else [])
        high = np.array(farthest, dtype=np.float32)
        low = np.where(np.arange(len(high)) == BEAMS, -high, np.float32(0.0))
        self.observation_space = spaces.Box(low, high, dtype=np.float32)
        self.action_space = spaces.Discrete(5)

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[np.ndarray, Dict[str, Any]]:
        super().reset(seed=seed)
        self._state = self._simulation.reset(int(self.np_random.integers(2**31)), STARTS[self._stage])
        self._set_goal(Pose2(*GOALS_XY[0]))
        self._render_if_live()
        return self._observation(), {"goal": (self._goal.x, self._goal.y)}

    def step(self, action: Any) -> Tuple[np.ndarray, float, bool, bool, Dict[str, Any]]:
        omega = (2 - int(action)) * TURN * 0.5
        self._state = state = self._simulation.step(Twist2(SPEED, omega))
        self._render_if_live()
        observation = self._observation()
        if state.touched or observation[:BEAMS].min() < COLLISION_DISTANCE:
            return (
                observation,
                self._rewards.collision,
                True,
                False,
                {"outcome": "collision", "is_success": False},
            )
        if observation[BEAMS + 1] < GOAL_RADIUS:
            self._set_goal(self._next_goal())
            return observation, self._rewards.goal, False, False, {"reached": True}
        return observation, self._reward(observation, int(action)), False, False, {}

    def render(self) -> Optional[np.ndarray]:  # type: ignore[override]
        if self._state is None:
            return None
        trajectories = self._simulation.arena.world.trajectories
        return self._renderer.show(
            self._simulation, self._state, Overlay((self._goal, GOAL_RADIUS), trajectories)
        )

    def close(self) -> None:
        self._renderer.close()
        self._simulation.close()

    def _render_if_live(self) -> None:
        if self._renderer.is_live:
            self.render()

    def _reward(self, observation: np.ndarray, action: int) -> float:
        """Reward for turning towards the goal, scaled by its distance, as in the tutorial."""
        angle = -math.pi / 4.0 + float(observation[BEAMS]) + math.pi / 8.0 * action + math.pi / 2.0
        turned = (0.25 + 0.5 * angle % (2.0 * math.pi) / math.pi) % 1.0
        facing = 1.0 - 4.0 * abs(0.5 - turned)
        rate = 2.0 ** (float(observation[BEAMS + 1]) / self._first_distance)
        near = self._rewards.near if observation[:BEAMS].min() < NEAR_DISTANCE else 0.0
        return round(5.0 * facing, 2) * rate + near

    def _set_goal(self, goal: Pose2) -> None:
        assert self._state is not None
        self._goal = goal
        self._first_distance = max(self._state.base_in_world.distance_to(goal), GOAL_RADIUS)

    def _next_goal(self) -> Pose2:
        """A different goal, away from the posts."""
        while True:
            if self._stage == 4:
                goal = Pose2(*GOALS_XY[self.np_random.integers(len(GOALS_XY))])
                if goal != self._goal:
                    return goal
                continue
            x, y = (self.np_random.integers(-12, 13, 2) / TENTHS).tolist()
            is_free = all(max(abs(x - px), abs(y - py)) > POST_CLEARANCE for px, py in POSTS_XY)
            if is_free and max(abs(x - self._goal.x), abs(y - self._goal.y)) >= 1.0:
                return Pose2(x, y)

    def _observation(self) -> np.ndarray:
        assert self._state is not None
        base, scan = self._state.base_in_world, self._state.scan
        beams = self._state.ranges(3.5, each=len(scan.ranges) // BEAMS)
        x, y = self._goal.x - base.x, self._goal.y - base.y
        goal_values = [wrap(math.atan2(y, x) - base.yaw), min(math.hypot(x, y), 10.0)]
        if self._stage > 1:
            goal_values += [float(beams.min()), float(beams.argmin())]
        return np.concatenate((beams, np.array(goal_values, dtype=np.float32)))


@lru_cache(maxsize=4)
def arena_of(stage: int) -> Arena:
    """Return the world of a stage with its moving bodies."""
    world = load_world(FOLDER / f"worlds/turtlebot3_stage_{stage}.world", [FOLDER / "models"])
    trajectories = _trajectories_of(stage, {body.name: body.pose_in_world[:2, 3] for body in world.bodies})
    moving = {trajectory.link for trajectory in trajectories}
    bodies = tuple(replace(body, is_kinematic=body.name in moving) for body in world.bodies)
    return Arena(replace(world, bodies=bodies, trajectories=trajectories), None, f"stage {stage}")


def _trajectories_of(stage: int, places_xy: Dict[str, np.ndarray]) -> Tuple[ScriptedTrajectory, ...]:
    if stage == 3:
        angles = np.linspace(0.0, 2.0 * math.pi, CORNERS + 1)
        turns = np.array([[np.cos(angles), np.sin(angles)], [-np.sin(angles), np.cos(angles)]])
        posts = {name: xy for name, xy in places_xy.items() if name.startswith("obstacle_")}
        times = np.linspace(0.0, CIRCLE_SECONDS, CORNERS + 1)
        return tuple(
            ScriptedTrajectory(name, times, np.einsum("i,ijk->kj", xy, turns)) for name, xy in posts.items()
        )
    if stage == 4:
        return tuple(
            ScriptedTrajectory(
                f"{name}::link", np.array(walk)[:, 0], places_xy[f"{name}::link"] + np.array(walk)[:, 1:]
            )
            for name, walk in WALKER_KEYFRAMES.items()
        )
    return ()
