"""Robots from URDF and SDF: their rigid parts, and what the <gazebo> plugins make of them."""

from sim_bridge.description.files import read_robot_file
from sim_bridge.description.profile import RobotProfile
from sim_bridge.description.robot import read_prop, read_sdf_robot, read_urdf_robot

__all__ = [
    "RobotProfile",
    "read_prop",
    "read_robot_file",
    "read_sdf_robot",
    "read_urdf_robot",
]
