"""Behaviour of the node move_base without ROS: stamped inputs in, decisions or complaints out."""

from move_base_lite.move_base.move_base import MoveBase, TickResult
from move_base_lite.move_base.robot_poses import PoseHistory, RobotPoses
from move_base_lite.move_base.sensor_inputs import Measurement

__all__ = ["Measurement", "MoveBase", "PoseHistory", "RobotPoses", "TickResult"]
