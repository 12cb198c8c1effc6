"""Keyboard teleoperation with the keys of turtlebot_teleop. ROS is in ``ros/`` only."""

from teleop_lite.config import TeleopSettings
from teleop_lite.key_script import KeyScript, KeyScriptError
from teleop_lite.teleop import Teleop

__all__ = ["KeyScript", "KeyScriptError", "Teleop", "TeleopSettings"]
