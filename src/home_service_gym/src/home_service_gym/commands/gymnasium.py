from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from home_service.options import count, seed
from supervision.command_line import argument, option


@dataclass(frozen=True)
class Gymnasium:
    """Plays episodes of a Gymnasium environment and says how they went."""

    environment: str = argument("its name, like PointGoal-v0", metavar="ENVIRONMENT")
    policy: str = option(
        "",
        "module/function: gets an observation, gives an action (default: actions by chance)",
        metavar="NAME",
    )
    arguments: str = option("{}", 'of the environment, like "{scenario: homes}"', metavar="YAML")
    seed: int = option(0, "of all chance", type=seed)
    episodes: int = option(1, "how many", type=count)
    gif: Optional[Path] = option(None, "an animation of them", type=Path)

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
