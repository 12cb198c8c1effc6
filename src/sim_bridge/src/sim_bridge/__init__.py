"""A headless simulator of wheeled robots in SDF worlds. Only ``sim_bridge.ros`` uses ROS."""

from typing import TYPE_CHECKING

from planar.deprecation import deprecated_names
from planar.lazy_names import lazy_names

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

__getattr__ = lazy_names(
    __name__,
    {
        "sim_bridge.config": ("SimulationSettings",),
        "sim_bridge.episode": ("Episode", "EpisodeHooks"),
        "sim_bridge.errors": ("RobotError", "WorldError"),
        "sim_bridge.robot": ("RobotWrappers", "StepResult"),
        "sim_bridge.robots": ("ROBOTS", "RobotProfile", "robot_named"),
        "sim_bridge.scene": ("Scene",),
        "sim_bridge.sdf": ("load_world",),
        "sim_bridge.simulation": ("Simulation",),
    },
    deprecated_names(__name__, {"Fitting": "RobotWrappers", "Observation": "StepResult"}),
)
