from dataclasses import dataclass
from pathlib import Path

from supervision.command_line import count, option, seed


@dataclass(frozen=True)
class Train:
    """Train the learned local planner of src/plugin_examples in generated homes, on CPUs.

    Uses an evolution strategy, and prints each generation (docs/how_to/train_a_planner.md).

    Exit code: 0 success, 2 invalid input, 130 interrupted.
    """

    generations: int = option(60, "number of generations", type=count)
    pairs: int = option(8, "antithetic pairs of each generation", type=count)
    episodes: int = option(4, "episodes for each candidate", type=count)
    workers: int = option(2, "number of processes", type=count)
    seed: int = option(0, "seed of all random numbers", type=seed)
    output: Path = option(Path("learned.npz"), "weights file, written after each generation", type=Path)

    def run(self) -> int:
        import numpy as np

        from home_service_gym.training import evolve
        from planar import SettingsError

        evolution = evolve(self.generations, self.pairs, self.episodes, self.workers, self.seed)
        for generation, total, share, weights in evolution:
            print(f"generation {generation}: return {total:.2f}, {share:.0%} succeeded", flush=True)
            try:
                np.savez(self.output, weights=weights.astype(np.float32))
            except OSError as error:
                raise SettingsError(f"{self.output}: cannot be written: {error.strerror}") from None
        return 0
