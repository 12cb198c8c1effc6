#!/usr/bin/env python3
"""Request a polygon: a client of the action /draw_polygon.

draw_polygon_client.py [SIDES [LENGTH]]
"""

import sys

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from learning_action.msg import DrawPolygonAction, DrawPolygonGoal

WAIT = rospy.Duration(10.0)


def draw(sides="5", length="1.5"):
    """Request a polygon; returns whether it was drawn, and the status text."""
    client = actionlib.SimpleActionClient("/draw_polygon", DrawPolygonAction)
    if not client.wait_for_server(WAIT):
        return False, "the action server /draw_polygon is not available"
    goal = DrawPolygonGoal(int(sides), float(length))
    client.send_goal(goal, feedback_cb=lambda feedback: rospy.loginfo("side %d", feedback.sides_drawn))
    if not client.wait_for_result(WAIT + rospy.Duration(goal.sides)):
        client.cancel_goal()
        return False, "no result in time, cancelled"
    if client.get_state() != GoalStatus.SUCCEEDED:
        return False, client.get_goal_status_text()
    return True, f"{client.get_result().distance:.1f} m drawn"


if __name__ == "__main__":
    rospy.init_node("draw_polygon_client")
    try:
        is_drawn, text = draw(*rospy.myargv()[1:])
    except (TypeError, ValueError) as error:
        is_drawn, text = False, error
    if not is_drawn:
        sys.exit(f"no polygon: {text}")
    rospy.loginfo("%s", text)
