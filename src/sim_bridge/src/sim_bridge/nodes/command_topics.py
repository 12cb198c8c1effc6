"""The topics that a robot takes its velocity from."""

from typing import Dict, List, Optional

import rospy
from geometry_msgs.msg import Twist
from std_msgs.msg import String

from planar import Twist2
from sim_bridge.mux import TURTLEBOT_INPUTS, Mux, Smoother, read_inputs

MUX = "cmd_vel_mux"
RAW_TOPIC = "navigation_velocity_smoother/raw_cmd_vel"
# What smoothed commands count as.
SMOOTHED_INPUT = "input/navi"
# Seconds of silence after which raw commands begin anew, and for which the first may accelerate.
LONGEST_PERIOD = 0.6
FIRST_PERIOD = 0.05


class CommandTopics:
    """The last command on any of some plain topics."""

    def __init__(self, robot: str, namespace: str, topics):
        self._robot = robot
        self._command: Optional[Twist2] = None
        self._connections: List = []
        for topic in topics:
            self._subscribe(namespace, topic, self._on_command)

    def take(self, _now: float) -> Optional[Twist2]:
        """The command that has come since the last call, if any."""
        command, self._command = self._command, None
        return command

    def close(self) -> None:
        for connection in self._connections:
            connection.unregister()

    def _subscribe(self, namespace: str, topic: str, callback, *arguments) -> None:
        name = rospy.names.ns_join(namespace, topic)
        self._connections.append(
            rospy.Subscriber(
                name, Twist, lambda message: callback(self._twist(message), *arguments), queue_size=1,
                tcp_nodelay=True,
            )
        )  # fmt: skip

    def _twist(self, message: Twist) -> Twist2:
        twist = Twist2(message.linear.x, message.angular.z)
        if not twist.is_finite():
            rospy.logwarn_throttle(1.0, f"{self._robot}: velocity command is not finite: the robot stops")
        return twist

    def _on_command(self, twist: Twist2) -> None:
        self._command = twist


class MuxTopics(CommandTopics):
    """Beside plain topics the inputs of cmd_vel_mux, those of the file that its parameter names if it is set.

    What comes on the smoother's topic counts as navigation's. Raises SettingsError.
    """

    def __init__(self, robot: str, namespace: str, topics):
        super().__init__(robot, namespace, topics)
        where = rospy.names.ns_join(namespace, MUX)
        file = rospy.get_param(f"{where}/yaml_cfg_file", "")
        self._mux, self._smoother = Mux(read_inputs(file) if file else TURTLEBOT_INPUTS), Smoother()
        self._smoothed_name = next((one.name for one in self._mux.inputs if one.topic == SMOOTHED_INPUT), "")
        self._arrived: Dict[str, Twist2] = {}
        self._raw: Optional[Twist2] = None
        self._raw_stamp = 0.0
        self._told = ""
        self._active = rospy.Publisher(f"{where}/active", String, queue_size=1, latch=True)
        self._connections.append(self._active)
        for one in self._mux.inputs:
            self._subscribe(where, one.topic, self._on_input, one.name)
        self._subscribe(namespace, RAW_TOPIC, self._on_raw)

    def take(self, now: float) -> Optional[Twist2]:
        arrived, self._arrived = self._arrived, {}
        raw, self._raw = self._raw, None
        if raw is not None and self._smoothed_name:
            arrived[self._smoothed_name] = self._smoothed(raw, now)
        chosen = self._mux.choose(now, arrived)
        active = self._mux.active(now)
        if active != self._told:
            self._told = active
            self._active.publish(active)
        return chosen or super().take(now)

    def _smoothed(self, raw: Twist2, now: float) -> Twist2:
        seconds, self._raw_stamp = now - self._raw_stamp, now
        if not 0.0 <= seconds < LONGEST_PERIOD:  # the robot has come to rest since
            self._smoother, seconds = Smoother(), FIRST_PERIOD
        return self._smoother.smooth(raw, seconds)

    def _on_input(self, twist: Twist2, name: str) -> None:
        self._arrived[name] = twist

    def _on_raw(self, twist: Twist2) -> None:
        self._raw = twist
