"""What all environments with a task have in common."""

from collections import OrderedDict
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, Optional, Tuple

import gymnasium
import numpy as np
from gymnasium import spaces

from home_service_gym.playground import Moment, Playground, lidar_of
from home_service_gym.surroundings import Surroundings
from home_service_gym.task import COLLISION, PERIOD, Task
from home_service_gym.viewing import MODES, Viewer
from laboratory.scenario import Scenario, read_scenario
from laboratory.suites import FOLDER
from planar import SettingsError, Twist2
from sim_bridge import robot_named

# Playgrounds that an environment keeps built, and control periods a second.
KEPT, RATE = 16, 10
# Odometry tells at most so many times a robot's greatest speed; one that slips or is bumped may be faster.
BUMPED = 2.0


def scenario_of(name: str) -> Scenario:
    """A scenario by its name in scenarios/, or by its file. Raises SettingsError."""
    path = Path(name)
    scenario = read_scenario(path if path.suffix == ".yaml" else FOLDER / f"{name}.yaml")
    if scenario.faults:
        raise SettingsError(f"{scenario.file}: happens.faults: environments play no faults")
    return scenario


class TaskEnv(gymnasium.Env):
    """A robot of a scenario, in its worlds and with its noise, that has a task.

    An observation has ``scan`` (m, as the lidar tells, 0 if too near, the greatest range if nothing is in
    reach), ``velocity`` (m/s and rad/s, of odometry, to ``BUMPED`` times the greatest) and what the task
    tells. An action is the share, -1 to 1, of the robot's greatest speed and turn rate. An episode ends with
    the task, or at the first touch.

    ``people``: so many, the nearest, are told of; ``has_map``: the map around the robot is told, too.
    ``reset(options={"seed": N})`` takes the world of that seed of the scenario; otherwise one is drawn.
    """

    metadata = {"render_modes": MODES, "render_fps": RATE}

    def __init__(
        self,
        scenario: Scenario,
        task: Task,
        render_mode: Optional[str] = None,
        people: int = 0,
        has_map: bool = False,
    ):
        self.render_mode = render_mode
        self._scenario = scenario
        self._task: Task = Surroundings(task, people, has_map) if people or has_map else task
        self._robot = robot_named(scenario.robot)
        self._viewer = Viewer(render_mode, self._robot, RATE)
        self._playgrounds: OrderedDict[int, Playground] = OrderedDict()
        self._playground: Optional[Playground] = None
        self._moment: Optional[Moment] = None
        lidar, drive = lidar_of(self._robot), self._robot.drive
        self._farthest = lidar.range_max
        self._most_v, self._most_omega = drive.max_speed, drive.max_turn_rate
        fastest = np.array((drive.max_speed, drive.max_turn_rate), np.float32) * BUMPED
        self._fastest = fastest.tolist()
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
        self._playground = self._playground_of(number)
        beginning = self._task.begin(self._playground, self.np_random)
        noise = int(self.np_random.integers(2**31))
        self._moment = self._playground.restart(noise, beginning.start, beginning.trajectories)
        self._show_people()
        return self._observation(), {"world": self._playground.arena.title}

    def step(self, action: np.ndarray) -> Tuple[Dict[str, np.ndarray], float, bool, bool, Dict[str, Any]]:
        assert self._playground is not None, "reset comes before step"
        v, omega = (min(max(share, -1.0), 1.0) for share in np.asarray(action).tolist())  # NaN stays NaN
        self._moment = self._playground.advance(Twist2(v * self._most_v, omega * self._most_omega))
        judgement = self._task.judge(self._moment)
        self._show_people()
        reward, outcome = judgement.reward, judgement.outcome
        if self._moment.touched:
            reward, outcome = PERIOD + COLLISION, "collision"
        info: Dict[str, Any] = {}
        if outcome:
            info = {"outcome": outcome, "is_success": outcome == "success"}
            if outcome == "collision":
                info["touched"] = self._moment.touched
        return self._observation(), float(reward), bool(outcome), False, info

    @property
    def moment(self) -> Moment:
        """What is so now, also what is not observed."""
        assert self._moment is not None, "reset comes first"
        return self._moment

    def render(self) -> Optional[np.ndarray]:  # type: ignore[override]
        if self._playground is None or self._moment is None:
            return None
        return self._viewer.show(self._playground, self._moment, self._task.marks())

    def close(self) -> None:
        for playground in self._playgrounds.values():
            playground.close()
        self._playgrounds.clear()
        self._viewer.close()
        self._playground = self._moment = None

    def _show_people(self) -> None:
        if self._viewer.is_live:
            self.render()

    def _playground_of(self, seed: int) -> Playground:
        """That of the world of a seed, built if it is not among the last that were used."""
        played = self._scenario
        differs = bool(played.boxes or played.doors or played.people.count)
        key = seed if differs else played.world.arena_number(seed)
        playground = self._playgrounds.pop(key, None)
        if playground is None:
            arena = self._scenario.arena(seed)
            bodies = (*arena.world.bodies, *self._task.bodies())
            arena = replace(arena, world=replace(arena.world, bodies=bodies))
            playground = Playground(arena, self._robot, self._scenario.simulation, self._scenario.start, RATE)
        self._playgrounds[key] = playground
        if len(self._playgrounds) > KEPT:
            self._playgrounds.popitem(last=False)[1].close()
        return playground

    def _observation(self) -> Dict[str, np.ndarray]:
        assert self._moment is not None
        twist = self._moment.twist
        told = zip((twist.v, twist.omega), self._fastest)
        velocity = [max(-fastest, min(speed, fastest)) for speed, fastest in told]
        return {
            "scan": self._moment.ranges(self._farthest),
            "velocity": np.array(velocity, dtype=np.float32),
            **self._task.observe(self._moment),
        }
