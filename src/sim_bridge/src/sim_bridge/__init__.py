"""A headless simulator of wheeled robots in SDF worlds. Only ``sim_bridge.ros`` uses ROS."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from planar.deprecation import deprecated_names

if TYPE_CHECKING:
    from sim_bridge.config import SimulationSettings
    from sim_bridge.episode import Episode, EpisodeHooks
    from sim_bridge.errors import RobotError, WorldError
    from sim_bridge.robot import RobotWrappers, StepResult
    from sim_bridge.robots import ROBOTS, RobotProfile, robot_named
    from sim_bridge.scene import Scene
    from sim_bridge.sdf import load_world
    from sim_bridge.simulation import Simulation

__all__ = [
    "Episode",
    "EpisodeHooks",
    "ROBOTS",
    "RobotError",
    "RobotProfile",
    "RobotWrappers",
    "Scene",
    "Simulation",
    "SimulationSettings",
    "StepResult",
    "WorldError",
    "load_world",
    "robot_named",
]

_MODULES = {
    "config": ("SimulationSettings",),
    "episode": ("Episode", "EpisodeHooks"),
    "errors": ("RobotError", "WorldError"),
    "robot": ("RobotWrappers", "StepResult"),
    "robots": ("ROBOTS", "RobotProfile", "robot_named"),
    "scene": ("Scene",),
    "sdf": ("load_world",),
    "simulation": ("Simulation",),
}
_MODULE_OF = {name: module for module, names in _MODULES.items() for name in names}
_deprecated = deprecated_names(__name__, {"Fitting": "RobotWrappers", "Observation": "StepResult"})


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used: a robot's profile alone does not load the simulator.

    Raises:
        AttributeError: There is no such name.
    """
    if name not in _MODULE_OF:
        return _deprecated(name)
    return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)
