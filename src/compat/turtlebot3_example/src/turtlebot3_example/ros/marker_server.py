"""The node ``turtlebot3_marker_server``: an interactive marker in rviz that drives the robot."""

from typing import Any

import rospy
from geometry_msgs.msg import Quaternion, Twist
from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerControl, InteractiveMarkerFeedback

from planar import PlanarError, Pose2
from planar_ros.messages.conversion import pose2_from_msg, pose2_to_msg
from planar_ros.node.runner import run
from planar_ros.node.topics import publish_on_shutdown

NAME, MARKER = "turtlebot3_marker_server", "turtlebot3_marker"
# The official topic, which the launch file renames to ``cmd_vel``.
COMMANDS = "interactive_marker_velocity_smoother/raw_cmd_vel"


class MarkerServer:
    """Publishes a velocity proportional to the marker's displacement, then resets the marker."""

    def __init__(self) -> None:
        self._linear_scale = rospy.get_param("~linear_scale", 1.0)
        self._angular_scale = rospy.get_param("~angular_scale", 2.2)
        self._publisher = rospy.Publisher(COMMANDS, Twist, queue_size=1)
        publish_on_shutdown(self._publisher, Twist())
        self._server = _server()
        self._server.insert(_marker(rospy.get_param("~link_name", "base_link")), self._follow)
        self._server.applyChanges()

    def _follow(self, feedback: InteractiveMarkerFeedback) -> None:
        displacement, message = pose2_from_msg(feedback.pose), Twist()
        message.linear.x = self._linear_scale * displacement.x
        message.angular.z = self._angular_scale * displacement.yaw
        self._publisher.publish(message)
        self._server.setPose(MARKER, pose2_to_msg(Pose2()))
        self._server.applyChanges()


def _server() -> Any:
    try:
        from interactive_markers.interactive_marker_server import InteractiveMarkerServer
    except ImportError as error:  # installed with rviz
        raise PlanarError(
            "python3-interactive-markers is not installed: ./scripts/setup.sh --rviz"
        ) from error
    return InteractiveMarkerServer(NAME)


def _marker(frame: str) -> InteractiveMarker:
    marker = InteractiveMarker(name=MARKER, scale=1.0, pose=pose2_to_msg(Pose2()))
    marker.header.frame_id = frame.lstrip("/")
    half = 0.5**0.5  # a control acts along the x axis of its frame: ahead, or upwards
    marker.controls = [
        _control("move_x", InteractiveMarkerControl.MOVE_AXIS, Quaternion(half, 0.0, 0.0, half)),
        _control("rotate_z", InteractiveMarkerControl.MOVE_ROTATE, Quaternion(0.0, half, 0.0, half)),
    ]
    return marker


def _control(name: str, mode: int, orientation: Quaternion) -> InteractiveMarkerControl:
    return InteractiveMarkerControl(
        name=name,
        orientation=orientation,
        orientation_mode=InteractiveMarkerControl.FIXED,
        interaction_mode=mode,
        always_visible=True,
    )


def main() -> None:
    run(NAME, MarkerServer)
