"""Topics and services of one turtle, in the namespace of its name."""

import threading

import rospy
from geometry_msgs.msg import Twist
from turtlesim.msg import Color, Pose
from turtlesim.srv import (
    SetPen,
    SetPenResponse,
    TeleportAbsolute,
    TeleportAbsoluteResponse,
    TeleportRelative,
    TeleportRelativeResponse,
)

from planar_ros.messages.validation import advertise_service, subscribe
from turtle_world.canvas import Pen
from turtle_world.world import TurtleState, TurtleVelocity, TurtleWorld

WARNING_SECONDS = 1.0


class TurtleTopics:
    """Passes commands and requests to the world, and publishes the state of the turtle."""

    def __init__(self, name: str, world: TurtleWorld, lock: threading.RLock):
        self._name, self._world, self._lock = name, world, lock
        self._pose = rospy.Publisher(f"{name}/pose", Pose, queue_size=1)
        self._color = rospy.Publisher(f"{name}/color_sensor", Color, queue_size=1)
        self._subscriber = subscribe(f"{name}/cmd_vel", Twist, self._on_command, queue_size=1)
        self._services = [
            advertise_service(f"{name}/set_pen", SetPen, self._on_set_pen),
            advertise_service(f"{name}/teleport_absolute", TeleportAbsolute, self._on_teleport_absolute),
            advertise_service(f"{name}/teleport_relative", TeleportRelative, self._on_teleport_relative),
        ]

    def publish(self, state: TurtleState) -> None:
        self._pose.publish(*state.pose, state.speed, state.turn)
        self._color.publish(*state.color)
        if state.blocked_target is not None:
            rospy.logwarn_throttle(
                WARNING_SECONDS,
                "Oh no! I hit the wall! (Clamping from [x={:f}, y={:f}])".format(*state.blocked_target),
            )

    def close(self) -> None:
        """Unregister all topics and services of a removed turtle."""
        for topic in (self._subscriber, self._pose, self._color):
            topic.unregister()
        for service in self._services:
            service.shutdown("the turtle has been removed")

    def _on_command(self, message):
        command = TurtleVelocity(message.linear.x, message.linear.y, message.angular.z)
        with self._lock:
            self._world.command(self._name, command)

    def _on_set_pen(self, request):
        with self._lock:
            before = self._world.pen_of(self._name)
            if request.off:
                pen = Pen(before.color, before.width, is_on=False)
            else:
                pen = Pen((request.r, request.g, request.b), request.width or 1)
            self._world.set_pen(self._name, pen)
        return SetPenResponse()

    def _on_teleport_absolute(self, request):
        with self._lock:
            self._world.teleport(self._name, request.x, request.y, request.theta)
        return TeleportAbsoluteResponse()

    def _on_teleport_relative(self, request):
        with self._lock:
            self._world.teleport_by(self._name, request.linear, request.angular)
        return TeleportRelativeResponse()
