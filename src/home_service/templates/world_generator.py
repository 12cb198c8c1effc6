"""TITLE: a world generator for the laboratory."""

from dataclasses import dataclass

import numpy as np

from laboratory.worlds.solids import FLOOR, post, wall
from laboratory.worlds.source import Arena
from planar import Pose2
from sim_bridge.world import World


@dataclass(frozen=True)
class CLASS:
    """A walled yard, ``size`` metres wide, with posts; the robot starts at its centre."""

    size: float = 8.0
    posts: int = 6

    def arena(self, seed: int) -> Arena:
        """See laboratory.worlds.custom.WorldGenerator; one seed always gives the same world."""
        rng, half = np.random.default_rng(seed), 0.5 * self.size
        sides = [
            wall("north", 0.0, half, self.size, 0.1),
            wall("south", 0.0, -half, self.size, 0.1),
            wall("east", half, 0.0, 0.1, self.size),
            wall("west", -half, 0.0, 0.1, self.size),
        ]
        apart, bearings = rng.uniform(1.0, half, self.posts), rng.uniform(-np.pi, np.pi, self.posts)
        places = [Pose2(r * np.cos(b), r * np.sin(b)) for r, b in zip(apart.tolist(), bearings.tolist())]
        posts = [post(f"post{number}", place, 0.15, 1.0) for number, place in enumerate(places)]
        return Arena(World("yard", (FLOOR, *sides, *posts)), title=f"yard {seed}")
