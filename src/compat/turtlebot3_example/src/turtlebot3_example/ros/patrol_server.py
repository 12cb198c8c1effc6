"""The node ``turtlebot3``: action server for patrols along a square, a triangle or a circle."""

from contextlib import suppress

import actionlib
import rospy

from planar_ros.node.runner import run
from turtlebot3_example.go_to_pose import figure_corners
from turtlebot3_example.msg import Turtlebot3Action, Turtlebot3Result
from turtlebot3_example.ros.odometry_controller import OdometryController


class PatrolServer:
    """Serves the action ``turtlebot3``."""

    def __init__(self) -> None:
        self._controller = OdometryController()
        self._server = actionlib.SimpleActionServer("turtlebot3", Turtlebot3Action, self._execute, False)
        self._server.start()
        rospy.loginfo("Server On")

    def _execute(self, request) -> None:
        with suppress(rospy.ROSInterruptException):  # Ctrl-C during a patrol
            self._patrol(request)

    def _patrol(self, request) -> None:
        mode, size, count = int(request.goal.x), request.goal.y, int(request.goal.z)
        try:
            corners = figure_corners(self._controller.base_in_odom(), mode, size) * max(count, 1)
        except (ValueError, rospy.ROSException) as error:
            self._server.set_aborted(Turtlebot3Result(str(error)), str(error))
            return
        if self._controller.follow(
            corners, align_yaw=False, should_continue=lambda: not self._server.is_preempt_requested()
        ):
            self._server.set_succeeded(Turtlebot3Result("patrolled"))
        else:
            self._server.set_preempted()


def main() -> None:
    run("turtlebot3", PatrolServer)
