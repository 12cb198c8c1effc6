#!/usr/bin/env python3
"""Draw polygons with turtle1: a server of this package's action, learning_action/DrawPolygon."""

import math

import actionlib
import rospy
from learning_action.msg import DrawPolygonAction, DrawPolygonFeedback, DrawPolygonResult
from turtlesim.srv import TeleportRelative

SIDE_SECONDS = 0.5


class DrawPolygonServer:
    def __init__(self):
        rospy.wait_for_service("/turtle1/teleport_relative", timeout=10.0)
        self._move = rospy.ServiceProxy("/turtle1/teleport_relative", TeleportRelative)
        self._server = actionlib.SimpleActionServer(
            "/draw_polygon", DrawPolygonAction, self._draw, auto_start=False
        )
        self._server.start()

    def _draw(self, goal):
        """Execute a goal, in a thread of the server; it can be preempted between two sides."""
        if goal.sides < 3 or not 0.0 < goal.length < 5.0:
            self._server.set_aborted(text="a polygon has at least 3 sides, of less than 5 m")
            return
        for drawn in range(goal.sides):
            if self._server.is_preempt_requested():
                self._server.set_preempted(DrawPolygonResult(drawn * goal.length), "stopped")
                return
            self._move(goal.length, 0.0)
            self._move(0.0, 2.0 * math.pi / goal.sides)
            self._server.publish_feedback(DrawPolygonFeedback(drawn + 1))
            rospy.sleep(SIDE_SECONDS)
        self._server.set_succeeded(DrawPolygonResult(goal.sides * goal.length), "drawn")


if __name__ == "__main__":
    rospy.init_node("draw_polygon_server")
    DrawPolygonServer()
    rospy.spin()
