"""The keyboard teleop of the TurtleBot3."""

import rospy

from teleop_lite.ros.node import TeleopVariant
from teleop_lite.ros.node import main as drive
from teleop_lite.turtlebot3 import KEYS, SteppedTeleop

BANNER = """
Control Your TurtleBot3!
---------------------------
Moving around:
        w
   a    s    d
        x

w/x : increase/decrease linear velocity (Burger : ~ 0.22, Waffle and Waffle Pi : ~ 0.26)
a/d : increase/decrease angular velocity (Burger : ~ 2.84, Waffle and Waffle Pi : ~ 1.82)

space key, s : force stop

CTRL-C to quit
"""
TURTLEBOT3 = TeleopVariant(
    program="turtlebot3_teleop_key",
    node_name="turtlebot3_teleop",
    topic="cmd_vel",
    banner=BANNER,
    keys=KEYS,
    make_driver=lambda: SteppedTeleop(rospy.get_param("model", "burger")),
    speeds="currently:\tlinear vel {v:.4g}\t angular vel {omega:.4g} ",
)


def main() -> None:
    drive(TURTLEBOT3)
