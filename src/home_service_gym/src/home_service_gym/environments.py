"""The environments with a task, by the names of their classes; docs/how_to/train_a_policy.md describes each.

``told`` is of every TaskEnv: ``render_mode``, ``people``, ``has_map``.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any, Optional

from home_service_gym.environment import RATE, TaskEnv, scenario_of
from home_service_gym.task import Task
from home_service_gym.tasks import errand, explore, follow, point_goal, reach
from laboratory.scenario import Scenario
from laboratory.tasks.deliveries import Deliveries
from laboratory.tasks.reach import Reach
from laboratory.worlds.barn import BarnFolder
from laboratory.worlds.dynabarn import DynabarnFolder
from planar import SettingsError
from planar.maps.places import load_pickup_and_dropoff


class PointGoal(TaskEnv):
    """From anywhere in a home to anywhere; ``lookahead``, m: ``waypoint`` is told that far on the way."""

    def __init__(self, scenario: str = "home_errand", lookahead: float = 0.0, **told: Any):
        super().__init__(scenario_of(scenario), point_goal.PointGoal(lookahead=lookahead), **told)


class HomeService(TaskEnv):
    """The errand of a scenario: to the pick-up zone, wait there, then to the drop-off zone."""

    def __init__(self, scenario: str = "home_errand", pickup_seconds: float = 5.0, **told: Any):
        played = scenario_of(scenario)
        if not isinstance(played.task, Deliveries) or played.task.mission is not None:
            raise SettingsError(f"{played.file}: task must be an errand")
        pickup, dropoff = load_pickup_and_dropoff(played.task.zones)
        task = errand.Errand(played.start, pickup.pose, dropoff.pose, pickup_seconds, RATE)
        super().__init__(played, task, **told)


class Barn(TaskEnv):
    """A Jackal through a field of cylinders; ``folder``: of the benchmark's own worlds."""

    def __init__(self, scenario: str = "fields", folder: Optional[str] = None, **told: Any):
        played = scenario_of(scenario)
        if folder is not None:
            source = BarnFolder(Path(folder).expanduser().resolve())
            source.pairs()
            played = replace(played, world=source)
        super().__init__(played, _reach(played), **told)


class Dynabarn(TaskEnv):
    """A Jackal between cylinders that move; ``folder``: of the benchmark's own worlds."""

    def __init__(self, scenario: str = "crossings", folder: Optional[str] = None, **told: Any):
        played = scenario_of(scenario)
        if folder is not None:
            source = DynabarnFolder(Path(folder).expanduser().resolve())
            source.files()
            played = replace(played, world=source)
        super().__init__(played, _reach(played), **told)


class Follow(TaskEnv):
    """After somebody who walks through a home."""

    def __init__(self, scenario: str = "home_errand", **told: Any):
        super().__init__(scenario_of(scenario), follow.Follow(), **told)


class Explore(TaskEnv):
    """See all of a home."""

    def __init__(self, scenario: str = "home_errand", **told: Any):
        super().__init__(scenario_of(scenario), explore.Explore(), **told)


def _reach(scenario: Scenario) -> Task:
    if not isinstance(scenario.task, Reach):
        raise SettingsError(f"{scenario.file}: task must be reach")
    return reach.Reach(scenario.start, scenario.task.goal, scenario.task.radius)
