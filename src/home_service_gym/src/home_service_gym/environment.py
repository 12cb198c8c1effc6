"""Base class of the environments whose robot, world and noise come from a scenario."""

from collections import OrderedDict
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, Optional, Tuple

import gymnasium
import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState, lidar_profile
from home_service_gym.people_and_map import PeopleAndMapTask
from home_service_gym.rendering import MODES, EpisodeRenderer
from home_service_gym.task import COLLISION_REWARD, PERIOD_REWARD, EpisodeTask
from laboratory.scenario import Scenario, read_scenario
from laboratory.suites import FOLDER
from planar import SettingsError, Twist2
from sim_bridge import robot_named

# Simulated worlds that an environment keeps, and control rate [Hz].
MAX_KEPT_WORLDS, RATE = 16, 10
# Bound of the observed velocity as a multiple of the maximum speed; wheel slip and collisions may exceed it.
MAX_SPEED_FACTOR = 2.0


def load_scenario(name: str) -> Scenario:
    """Read a scenario by its name in scenarios/ or its file. Raises SettingsError."""
    path = Path(name)
    scenario = read_scenario(path if path.suffix == ".yaml" else FOLDER / f"{name}.yaml")
    if scenario.faults:
        raise SettingsError(f"{scenario.file}: happens.faults: environments do not support faults")
    return scenario


class TaskEnv(gymnasium.Env):
    """Environment with the robot, worlds and noise of a scenario, and a task.

    Observations are dictionaries of ``scan`` (ranges [m]: 0 if too close, the maximum range without an echo),
    ``velocity`` (of odometry [m/s, rad/s], clipped to ``MAX_SPEED_FACTOR`` times the maximum) and the entries
    of the task. An action is a pair of shares, -1 to 1, of the maximum speed and turn rate. An episode
    terminates with the task or at the first collision. ``reset(options={"seed": N})`` selects the world of a
    seed of the scenario; otherwise one is drawn.

    Args:
        scenario: Scenario with robot, worlds, noise and start pose.
        task: Task with observations and rewards.
        render_mode: ``rgb_array``, ``human`` or None.
        people: Number of nearest pedestrians to observe.
        has_map: Whether the map around the robot is observed.
    """

    metadata = {"render_modes": MODES, "render_fps": RATE}

    def __init__(
        self,
        scenario: Scenario,
        task: EpisodeTask,
        render_mode: Optional[str] = None,
        people: int = 0,
        has_map: bool = False,
    ):
        self.render_mode = render_mode
        self._scenario = scenario
        self._task: EpisodeTask = PeopleAndMapTask(task, people, has_map) if people or has_map else task
        self._robot = robot_named(scenario.robot)
        self._renderer = EpisodeRenderer(render_mode, self._robot, RATE)
        self._simulations: OrderedDict[int, EpisodeSimulation] = OrderedDict()
        self._simulation: Optional[EpisodeSimulation] = None
        self._state: Optional[EpisodeState] = None
        lidar, drive = lidar_profile(self._robot), self._robot.drive
        self._range_max = lidar.range_max
        self._max_v, self._max_omega = drive.max_speed, drive.max_turn_rate
        fastest = np.array((drive.max_speed, drive.max_turn_rate), np.float32) * MAX_SPEED_FACTOR
        self._max_velocity = fastest.tolist()
        self.action_space = spaces.Box(-1.0, 1.0, (2,), np.float32)
        self.observation_space = spaces.Dict(
            {
                "scan": spaces.Box(0.0, np.float32(lidar.range_max), (lidar.beams,), np.float32),
                "velocity": spaces.Box(-fastest, fastest, dtype=np.float32),
                **self._task.spaces(),
            }
        )

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[Dict[str, np.ndarray], Dict[str, Any]]:
        super().reset(seed=seed)
        number = int((options or {}).get("seed", self.np_random.choice(self._scenario.seeds)))
        self._simulation = self._simulation_for(number)
        episode_start = self._task.reset(self._simulation, self.np_random)
        noise = int(self.np_random.integers(2**31))
        self._state = self._simulation.reset(noise, episode_start.start, episode_start.trajectories)
        self._render_if_live()
        return self._observation(), {"world": self._simulation.arena.title}

    def step(self, action: np.ndarray) -> Tuple[Dict[str, np.ndarray], float, bool, bool, Dict[str, Any]]:
        assert self._simulation is not None, "reset comes before step"
        v, omega = (min(max(share, -1.0), 1.0) for share in np.asarray(action).tolist())  # NaN stays NaN
        self._state = self._simulation.step(Twist2(v * self._max_v, omega * self._max_omega))
        task_step = self._task.step(self._state)
        self._render_if_live()
        reward, outcome = task_step.reward, task_step.outcome
        if self._state.touched:
            reward, outcome = PERIOD_REWARD + COLLISION_REWARD, "collision"
        info: Dict[str, Any] = {}
        if outcome:
            info = {"outcome": outcome, "is_success": outcome == "success"}
            if outcome == "collision":
                info["touched"] = self._state.touched
        return self._observation(), float(reward), bool(outcome), False, info

    @property
    def state(self) -> EpisodeState:
        """Current state of the simulation, including what is not observed."""
        assert self._state is not None, "reset comes first"
        return self._state

    def render(self) -> Optional[np.ndarray]:  # type: ignore[override]
        if self._simulation is None or self._state is None:
            return None
        return self._renderer.show(self._simulation, self._state, self._task.overlay())

    def close(self) -> None:
        for simulation in self._simulations.values():
            simulation.close()
        self._simulations.clear()
        self._renderer.close()
        self._simulation = self._state = None

    def _render_if_live(self) -> None:
        if self._renderer.is_live:
            self.render()

    def _simulation_for(self, seed: int) -> EpisodeSimulation:
        """The simulation of a seed's world, from the cache if possible."""
        scenario = self._scenario
        depends_on_seed = bool(scenario.boxes or scenario.doors or scenario.people.count)
        key = seed if depends_on_seed else scenario.world.arena_number(seed)
        simulation = self._simulations.pop(key, None)
        if simulation is None:
            arena = scenario.arena(seed)
            bodies = (*arena.world.bodies, *self._task.bodies())
            arena = replace(arena, world=replace(arena.world, bodies=bodies))
            simulation = EpisodeSimulation(arena, self._robot, scenario.simulation, scenario.start, RATE)
        self._simulations[key] = simulation
        if len(self._simulations) > MAX_KEPT_WORLDS:
            self._simulations.popitem(last=False)[1].close()
        return simulation

    def _observation(self) -> Dict[str, np.ndarray]:
        assert self._state is not None
        twist = self._state.twist
        limits = zip((twist.v, twist.omega), self._max_velocity)
        velocity = [max(-fastest, min(speed, fastest)) for speed, fastest in limits]
        return {
            "scan": self._state.ranges(self._range_max),
            "velocity": np.array(velocity, dtype=np.float32),
            **self._task.observation(self._state),
        }
