"""The command turtlebot3_client: reads a patrol from stdin and sends it to the action server."""

import sys

import actionlib
import rospy

from planar_ros.node.runner import init_node
from turtlebot3_example.msg import Turtlebot3Action, Turtlebot3Goal
from turtlebot3_example.ros.input_lines import read_lines

MESSAGE = """
patrol your TurtleBot3!
-----------------------
mode : s - Patrol to Square
       t - Patrol to Triangle
       c - Patrol to Circle

area : Square, Triangle mode - length of side (m)
       Circle mode - radius (m)

count - patrol count

If you want to close, insert 'x'
| mode | area | count |
"""
MODES = {"s": 1, "t": 2, "c": 3}
SERVER_SECONDS = 30.0


def main() -> None:
    """Exit code 0 if the last patrol succeeded or none was entered, 1 if it failed, 2 on invalid input."""
    init_node("turtlebot3_client", disable_signals=False)
    client = actionlib.SimpleActionClient("turtlebot3", Turtlebot3Action)
    is_done = True
    print(MESSAGE, flush=True)
    for line in read_lines():
        if line.strip() in ("", "x"):
            break
        try:
            mode, area, count = line.split()
            goal = Turtlebot3Goal()
            goal.goal.x, goal.goal.y, goal.goal.z = MODES[mode], float(area), int(count)
        except (KeyError, ValueError):
            print(f"expected a mode (s, t, c), an area and a count, got {line.strip()!r}", file=sys.stderr)
            sys.exit(2)
        if not client.wait_for_server(rospy.Duration(SERVER_SECONDS)):
            print("the action server turtlebot3 is not available", file=sys.stderr)
            sys.exit(1)
        client.send_goal_and_wait(goal)
        is_done = client.get_state() == actionlib.GoalStatus.SUCCEEDED
        result = client.get_result()
        rospy.loginfo(result.result if result else "cancelled")
        print(MESSAGE, flush=True)
    sys.exit(0 if is_done else 1)
