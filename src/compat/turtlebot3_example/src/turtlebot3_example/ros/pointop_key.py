"""The command turtlebot3_pointop_key: drives to poses from stdin: x, y in odom [m], and yaw in degrees."""

import math
import sys
from contextlib import suppress

import rospy

from planar import Pose2
from planar_ros.node.runner import init_node
from turtlebot3_example.ros.input_lines import read_lines
from turtlebot3_example.ros.odometry_controller import OdometryController

MESSAGE = """
control your Turtlebot3!
-----------------------
Insert xyz - coordinate.
x : position x (m)
y : position y (m)
z : orientation z (degree: -180 ~ 180)
If you want to close, insert 's'
-----------------------
| x | y | z |
"""


def main() -> None:
    """Exit code 0, 1 without odometry, or 2 on invalid input."""
    init_node("turtlebot3_pointop_key", disable_signals=False)
    try:
        with suppress(rospy.ROSInterruptException):
            _drive_to_entered_poses(OdometryController())
    except rospy.ROSException as error:
        print(error, file=sys.stderr)
        sys.exit(1)


def _drive_to_entered_poses(controller: OdometryController) -> None:
    print(MESSAGE, flush=True)
    for line in read_lines():
        if line.strip() in ("", "s"):
            break
        try:
            x, y, degrees = (float(word) for word in line.split())
        except ValueError:
            x = y = degrees = math.nan
        if not all(map(math.isfinite, (x, y))) or not -180.0 <= degrees <= 180.0:
            print(f"expected x, y and -180 to 180 degrees, got {line.strip()!r}", file=sys.stderr)
            sys.exit(2)
        controller.follow([Pose2(x, y, math.radians(degrees))], align_yaw=True)
        base_in_odom = controller.base_in_odom()
        rospy.loginfo(
            "reached: %.2f %.2f %.0f", base_in_odom.x, base_in_odom.y, math.degrees(base_in_odom.yaw)
        )
        print(MESSAGE, flush=True)
