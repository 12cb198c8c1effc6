"""A headless simulator of a wheeled robot in SDF worlds; only ``ros`` knows of ROS."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sim_bridge.config import SimulationSettings
    from sim_bridge.errors import RobotError, WorldError
    from sim_bridge.robot import Fitting, Observation
    from sim_bridge.robots import ROBOTS, RobotProfile, robot_named
    from sim_bridge.scene import Scene
    from sim_bridge.sdf import load_world
    from sim_bridge.simulation import Simulation

__all__ = [
    "ROBOTS",
    "Fitting",
    "Observation",
    "RobotError",
    "RobotProfile",
    "Scene",
    "Simulation",
    "SimulationSettings",
    "WorldError",
    "load_world",
    "robot_named",
]

_MODULES = {
    "config": ("SimulationSettings",),
    "errors": ("RobotError", "WorldError"),
    "robot": ("Fitting", "Observation"),
    "robots": ("ROBOTS", "RobotProfile", "robot_named"),
    "scene": ("Scene",),
    "sdf": ("load_world",),
    "simulation": ("Simulation",),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> Any:
    """Imported when first asked for: who only wants to know a robot need not wait for the simulator."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
