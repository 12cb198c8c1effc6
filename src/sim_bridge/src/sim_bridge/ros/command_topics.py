"""Topics of velocity commands of a robot."""

from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import rospy
from geometry_msgs.msg import Twist
from rosgraph.names import ns_join
from std_msgs.msg import String

from planar import SettingsError, Twist2
from planar.config.parameters import DynamicParameter
from planar_ros.node.parameters import ReconfigureServer
from sim_bridge.driving.mux import (
    TURTLEBOT_INPUTS,
    MuxInput,
    VelocityMux,
    VelocitySmoother,
    parse_inputs,
    read_inputs,
)

MUX = "cmd_vel_mux"
MUX_FILE, MUX_TEXT = "yaml_cfg_file", "yaml_cfg_data"
RAW_TOPIC = "navigation_velocity_smoother/raw_cmd_vel"
# The input of the mux that smoothed commands belong to.
SMOOTHED_INPUT = "input/navi"


class CommandTopics:
    """Stores the latest velocity command received on any of several topics.

    Args:
        robot: Name of the robot, for the log.
        namespace: Namespace of the topics.
        topics: Names of the topics.

    Attributes:
        received: Number of commands received.
    """

    def __init__(self, robot: str, namespace: str, topics):
        self._robot, self.received = robot, 0
        self._command: Optional[Twist2] = None
        self._connections: List = []
        for topic in topics:
            self._connections.append(self._subscribed(namespace, topic, self._on_command))

    def pop(self, _now: float) -> Optional[Twist2]:
        """Return the command received since the last call; None if there is none.

        Args:
            _now: Simulated time [s].
        """
        command, self._command = self._command, None
        return command

    def close(self) -> None:
        for connection in self._connections:
            connection.unregister()

    def _subscribed(self, namespace: str, topic: str, callback: Callable, *arguments) -> rospy.Subscriber:
        name = ns_join(namespace, topic)
        return rospy.Subscriber(
            name, Twist, lambda message: callback(self._twist(message), *arguments), queue_size=1,
            tcp_nodelay=True,
        )  # fmt: skip

    def _twist(self, message: Twist) -> Twist2:
        self.received += 1
        twist = Twist2(message.linear.x, message.angular.z, message.linear.y)
        if not twist.is_finite():
            rospy.logwarn_throttle(1.0, f"{self._robot}: velocity command is not finite: the robot stops")
        return twist

    def _on_command(self, twist: Twist2) -> None:
        self._command = twist


class MuxTopics(CommandTopics):
    """Topics of commands with the inputs of cmd_vel_mux (yocs_cmd_vel_mux) and the velocity smoother.

    The inputs are those of the file that the mux's parameter names, else a TurtleBot's. Smoothed commands
    belong to navigation's input. As with the official mux, dynamic_reconfigure replaces the inputs by those
    of a file or a text.

    Raises:
        SettingsError: The file has an error.
    """

    def __init__(self, robot: str, namespace: str, topics):
        super().__init__(robot, namespace, topics)
        self._where = where = ns_join(namespace, MUX)
        file = rospy.get_param(f"{where}/{MUX_FILE}", "")
        self._smoother = VelocitySmoother()
        self._arrived: Dict[str, Twist2] = {}
        self._raw: Optional[Twist2] = None
        self._published_active = ""
        self._active = rospy.Publisher(f"{where}/active", String, queue_size=1, latch=True)
        self._inputs: List[rospy.Subscriber] = []
        self._subscribe_inputs(self._inputs_of(file))
        self._connections += [self._active, self._subscribed(namespace, RAW_TOPIC, self._on_raw)]
        self._tuning = self._reconfigure_server({MUX_FILE: file, MUX_TEXT: ""})

    def close(self) -> None:
        super().close()
        if self._tuning is not None:
            self._tuning.close()
        for subscriber in self._inputs:
            subscriber.unregister()

    def pop(self, now: float) -> Optional[Twist2]:
        arrived, self._arrived = self._arrived, {}
        raw, self._raw = self._raw, None
        if raw is not None:
            self._smoother.set_target(raw, now)
        smoothed = self._smoother.command(now)
        if smoothed is not None and self._smoothed_name:
            arrived[self._smoothed_name] = smoothed
        chosen = self._mux.choose(now, arrived)
        active = self._mux.active(now)
        if active != self._published_active:
            self._published_active = active
            self._active.publish(active)
        return chosen or super().pop(now)

    def _reconfigure_server(self, values: Dict[str, str]) -> Optional[ReconfigureServer]:
        tunables = (
            DynamicParameter(MUX_FILE, "", "path of a YAML file of the mux's inputs"),
            DynamicParameter(MUX_TEXT, "", "the inputs as YAML, instead of a file"),
        )
        try:
            return ReconfigureServer(tunables, values, self._on_reconfigure, self._where)
        except rospy.ServiceException:  # another robot of the namespace has it already
            return None

    def _subscribe_inputs(self, inputs: Sequence[MuxInput]) -> None:
        for subscriber in self._inputs:
            subscriber.unregister()
        self._mux = VelocityMux(inputs)
        self._smoothed_name = next((one.name for one in inputs if one.topic == SMOOTHED_INPUT), "")
        self._inputs = [self._subscribed(self._where, one.topic, self._on_input, one.name) for one in inputs]

    def _on_reconfigure(self, values: Dict[str, Any]) -> Dict[str, Any]:
        """Replace the inputs; keep them if the new ones have an error."""
        try:
            self._subscribe_inputs(self._inputs_of(values[MUX_FILE], values[MUX_TEXT]))
        except SettingsError as error:
            rospy.logerr("%s", error)
        return values

    def _inputs_of(self, file: str, text: str = "") -> Tuple[MuxInput, ...]:
        """Return the inputs of the text, else of the file, else a TurtleBot's."""
        if text:
            return parse_inputs(text, f"{self._where}/{MUX_TEXT}")
        return read_inputs(file) if file else TURTLEBOT_INPUTS

    def _on_input(self, twist: Twist2, name: str) -> None:
        self._arrived[name] = twist

    def _on_raw(self, twist: Twist2) -> None:
        self._raw = twist
