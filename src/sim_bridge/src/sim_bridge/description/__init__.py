"""Reads robots from URDF and SDF: rigid parts, and drives and sensors of Gazebo plugins."""

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
