"""move_base in an episode, with the CPU time of its ticks."""

import time
from typing import List, Optional

import numpy as np

from headless_mission.navigation import NavigationHooks
from move_base_lite import NavigatorSettings
from planar import OccupancyGrid
from sim_bridge import Episode, StepResult


class TimedNavigation(NavigationHooks):
    """Measures each tick.

    Attributes:
        tick_ms: CPU time of each tick with usable inputs [ms].
        recoveries: Number of recovery behaviours that were started.
        planned: Length of the first plan [m]; 0 before it.
    """

    def __init__(self, settings: NavigatorSettings, grid: Optional[OccupancyGrid] = None):
        super().__init__(settings, grid)
        self.tick_ms: List[float] = []
        self.recoveries, self.planned = 0, 0.0

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        start = time.process_time()
        super().at_tick(episode, step)
        milliseconds, decision = 1e3 * (time.process_time() - start), self.result.decision
        if self.result.state is not None:
            self.tick_ms.append(milliseconds)
        self.recoveries += decision.recovery is not None
        if decision.plan_xy is not None and not self.planned:
            self.planned = float(np.linalg.norm(np.diff(decision.plan_xy, axis=0), axis=1).sum())
