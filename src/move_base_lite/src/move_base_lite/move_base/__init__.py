"""Behaviour of the node move_base without ROS: stamped inputs in, decisions or complaints out."""

from move_base_lite.move_base.move_base import MoveBase, TickResult
from move_base_lite.move_base.observation_buffer import Measurement
from move_base_lite.move_base.placement import SensorData
from move_base_lite.move_base.robot_poses import PoseHistory, RobotPoses

__all__ = ["Measurement", "MoveBase", "PoseHistory", "RobotPoses", "SensorData", "TickResult"]
