"""Keyboard teleop with turtlebot_teleop's keys; pure but for node.py and terminal.py."""

from teleop_lite.config import TeleopSettings
from teleop_lite.key_script import KeyScript, KeyScriptError
from teleop_lite.teleop import Teleop

__all__ = ["KeyScript", "KeyScriptError", "Teleop", "TeleopSettings"]
