from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from supervision.command_line import argument, count, option, seed


@dataclass(frozen=True)
class Gymnasium:
    """Run episodes of a Gymnasium environment and print their outcomes.

    The environments: docs/how_to/train_a_policy.md.

    Exit code: 0 success, 2 invalid input, 130 interrupted.
    """

    environment: str = argument("environment id, such as PointGoal-v0", metavar="ENVIRONMENT")
    policy: str = option(
        "",
        "module/function: takes an observation, returns an action (default: random actions)",
        metavar="NAME",
    )
    arguments: str = option("{}", 'arguments of the environment, such as "{scenario: homes}"', metavar="YAML")
    seed: int = option(0, "seed of the first episode", type=seed)
    episodes: int = option(1, "number of episodes", type=count)
    gif: Optional[Path] = option(None, "write an animation to this file", type=Path)

    def run(self) -> int:
        from home_service_gym.episodes import EpisodeRunner, load_policy, make_environment

        env = make_environment(self.environment, self.arguments)
        try:
            episodes = EpisodeRunner(env, load_policy(self.policy, env, self.seed), self.gif is not None)
            for number in range(self.episodes):
                print(f"seed {self.seed + number}: {episodes.run(self.seed + number)}", flush=True)
        finally:
            env.close()
        if self.gif is not None:
            episodes.save(self.gif)
        return 0
