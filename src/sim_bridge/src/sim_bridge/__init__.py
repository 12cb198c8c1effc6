"""A headless simulator of a wheeled robot in SDF worlds; only ``ros`` knows of ROS."""

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
