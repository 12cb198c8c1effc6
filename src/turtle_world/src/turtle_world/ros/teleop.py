"""The node ``teleop_turtle``: drives turtle1 with the arrow keys, as turtlesim's turtle_teleop_key."""

import sys

import rospy
from geometry_msgs.msg import Twist

from planar import PlanarError
from planar_ros.node.runner import run
from teleop_lite.terminal import CTRL_C, Terminal

# Last character of an arrow key's escape sequence -> fractions of the linear and angular scale.
ARROWS = {"A": (1.0, 0.0), "B": (-1.0, 0.0), "C": (0.0, -1.0), "D": (0.0, 1.0)}
QUIT = ("q", CTRL_C)
POLL_SECONDS = 0.2
BANNER = """Reading from keyboard
---------------------------
Use arrow keys to move the turtle. 'q' to quit."""


def main():
    try:
        terminal = Terminal(sys.stdin.fileno())
        run("teleop_turtle", lambda: _drive(terminal))
    except PlanarError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)


def _drive(terminal):
    publisher = rospy.Publisher("turtle1/cmd_vel", Twist, queue_size=1)
    scale_linear, scale_angular = rospy.get_param("scale_linear", 2.0), rospy.get_param("scale_angular", 2.0)
    print(BANNER)
    with terminal:
        while not rospy.is_shutdown():
            keys = terminal.read(POLL_SECONDS)
            if any(key in keys for key in QUIT):
                break
            for ahead, left in _arrows_in(keys):
                twist = Twist()
                twist.linear.x, twist.angular.z = scale_linear * ahead, scale_angular * left
                publisher.publish(twist)
    rospy.signal_shutdown("quit")


def _arrows_in(keys: str):
    """Parse the escape sequences of arrow keys: ESC, ``[`` or ``O``, and a letter."""
    for sequence in keys.split("\x1b")[1:]:
        if sequence[:1] in ("[", "O") and sequence[1:2] in ARROWS:
            yield ARROWS[sequence[1:2]]
