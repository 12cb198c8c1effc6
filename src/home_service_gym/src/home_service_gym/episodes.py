"""Episodes of an environment with a policy."""

from pathlib import Path
from typing import Any, Callable, Dict, List

import gymnasium
import numpy as np
from PIL import Image

from home_service_gym import NAMES
from planar import PlanarError, SettingsError
from planar.config.hints import hint
from planar.config.yaml_table import parse_table
from planar.extensions import load_object

Policy = Callable[[Any], Any]
# Control periods between two frames of an animation.
FRAME_PERIODS = 3


def make_environment(name: str, arguments: str) -> gymnasium.Env[Any, Any]:
    """Make an environment; ``arguments`` of its constructor as a YAML mapping. Raises SettingsError."""
    if name not in NAMES:
        raise SettingsError(
            f"no environment named {name!r}{hint(name, NAMES)} (there are {', '.join(NAMES)})"
        )
    parsed: Dict[str, Any] = parse_table(arguments, "--arguments").values()
    try:
        return gymnasium.make(name, render_mode="rgb_array", **parsed)
    except PlanarError:
        raise
    except TypeError as error:
        raise SettingsError(f"{name}: {error}") from None


def load_policy(name: str, env: gymnasium.Env[Any, Any], seed: int) -> Policy:
    """Load a policy by its dotted name; an empty name: random actions. Raises SettingsError."""
    if name:
        return load_object(name)
    env.action_space.seed(seed)
    return lambda observation: env.action_space.sample()


class EpisodeRunner:
    """Runs episodes of one environment with one policy.

    Args:
        env: The environment.
        policy: Maps an observation to an action.
        is_recording: Whether frames are recorded for an animation.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], policy: Policy, is_recording: bool):
        self._env, self._policy, self._is_recording = env, policy, is_recording
        self._frames: List[np.ndarray] = []

    def run(self, seed: int) -> str:
        """Run an episode; return its outcome in one line."""
        observation, _ = self._env.reset(seed=seed)
        total, periods, is_over = 0.0, 0, False
        while not is_over:
            if self._is_recording and periods % FRAME_PERIODS == 0:
                self._frames.append(np.asarray(self._env.render()))
            observation, reward, terminated, truncated, info = self._env.step(self._policy(observation))
            total, periods = total + float(reward), periods + 1
            is_over = terminated or truncated
        return f"{info.get('outcome', 'time limit')} after {periods} steps, return {total:.1f}"

    def save(self, path: Path) -> None:
        """Write the animation. Raises SettingsError if that fails."""
        first, *others = [Image.fromarray(frame) for frame in self._frames]
        try:
            first.save(path, save_all=True, append_images=others, duration=100 * FRAME_PERIODS, loop=0)
        except (OSError, ValueError) as error:
            raise SettingsError(f"{path}: cannot be written: {error}") from None
