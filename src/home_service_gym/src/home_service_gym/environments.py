"""The environments with a task, described in docs/reference/gymnasium.md.

``options`` are the arguments of every TaskEnv: ``render_mode``, ``people`` and ``has_map``.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any, Optional

from home_service_gym.environment import RATE, TaskEnv, load_scenario
from home_service_gym.task import EpisodeTask
from home_service_gym.tasks import errand, explore, follow, point_goal, reach
from laboratory.scenario import Scenario
from laboratory.tasks.deliveries import DeliveryTask
from laboratory.tasks.odom_goal import OdomGoalTask
from laboratory.worlds.barn import BarnFolder
from laboratory.worlds.dynabarn import DynabarnFolder
from planar import SettingsError
from planar.maps.places import load_pickup_and_dropoff


class PointGoalEnv(TaskEnv):
    """From a random pose to a random goal; ``lookahead``: distance of the observed ``waypoint`` [m]."""

    def __init__(self, scenario: str = "home_errand", lookahead: float = 0.0, **options: Any):
        super().__init__(load_scenario(scenario), point_goal.PointGoalTask(lookahead=lookahead), **options)


class HomeServiceEnv(TaskEnv):
    """The errand of a scenario: wait in the pick-up zone, then drive to the drop-off zone."""

    def __init__(self, scenario: str = "home_errand", pickup_seconds: float = 5.0, **options: Any):
        base = load_scenario(scenario)
        if not isinstance(base.task, DeliveryTask) or base.task.mission is not None:
            raise SettingsError(f"{base.file}: task must be an errand")
        pickup, dropoff = load_pickup_and_dropoff(base.task.zones)
        task = errand.ErrandTask(base.start, pickup.pose, dropoff.pose, pickup_seconds, RATE)
        super().__init__(base, task, **options)


class BarnEnv(TaskEnv):
    """A Jackal in a field of cylinders; ``folder``: the worlds of the BARN benchmark."""

    def __init__(self, scenario: str = "fields", folder: Optional[str] = None, **options: Any):
        base = load_scenario(scenario)
        if folder is not None:
            source = BarnFolder(Path(folder).expanduser().resolve())
            source.pairs()
            base = replace(base, world=source)
        super().__init__(base, _reach(base), **options)


class DynabarnEnv(TaskEnv):
    """A Jackal among moving cylinders; ``folder``: the worlds of the DynaBARN benchmark."""

    def __init__(self, scenario: str = "crossings", folder: Optional[str] = None, **options: Any):
        base = load_scenario(scenario)
        if folder is not None:
            source = DynabarnFolder(Path(folder).expanduser().resolve())
            source.files()
            base = replace(base, world=source)
        super().__init__(base, _reach(base), **options)


class FollowEnv(TaskEnv):
    """Follow a person who walks through a home."""

    def __init__(self, scenario: str = "home_errand", **options: Any):
        super().__init__(load_scenario(scenario), follow.FollowTask(), **options)


class ExploreEnv(TaskEnv):
    """Explore a home with the lidar."""

    def __init__(self, scenario: str = "home_errand", **options: Any):
        super().__init__(load_scenario(scenario), explore.ExploreTask(), **options)


def _reach(scenario: Scenario) -> EpisodeTask:
    if not isinstance(scenario.task, OdomGoalTask):
        raise SettingsError(f"{scenario.file}: task must be reach")
    return reach.ReachTask(scenario.start, scenario.task.goal, scenario.task.radius)
