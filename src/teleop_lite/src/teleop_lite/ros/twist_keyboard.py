"""The keyboard teleop of teleop_twist_keyboard: the same keys as turtlebot_teleop's, for any robot."""

from dataclasses import replace

import rospy

from teleop_lite.config import TeleopSettings
from teleop_lite.ros.node import TURTLEBOT
from teleop_lite.ros.node import main as drive
from teleop_lite.teleop import Teleop

SPEED, TURN = 0.5, 1.0
TWIST_KEYBOARD = replace(
    TURTLEBOT,
    program="teleop_twist_keyboard.py",
    node_name="teleop_twist_keyboard",
    topic="cmd_vel",
    banner=TURTLEBOT.banner.replace("Turtlebot", "Robot"),
    make_driver=lambda: Teleop(
        TeleopSettings(rospy.get_param("~speed", SPEED), rospy.get_param("~turn", TURN))
    ),
)


def main() -> None:
    drive(TWIST_KEYBOARD)
