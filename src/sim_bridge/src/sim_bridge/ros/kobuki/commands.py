"""Commands of a Kobuki base other than its velocity, below mobile_base (kobuki_gazebo_plugins)."""

import rospy
from kobuki_msgs.msg import Led, MotorPower, Sound
from rosgraph.names import ns_join
from std_msgs.msg import Empty

from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.kobuki.topics import NAMESPACE
from sim_bridge.scene import Scene


class KobukiCommands:
    """Subscribes to commands for motors, odometry, LEDs and sound of a robot.

    Args:
        scene: The simulated world.
        name: Name of the robot's model.
        namespace: Namespace of the topics.
        calls: Queue of the thread that owns the scene.
    """

    def __init__(self, scene: Scene, name: str, namespace: str, calls: CallQueue):
        self._scene = scene
        self._name = name
        self._calls = calls
        self._where = ns_join(namespace, NAMESPACE)
        self._subscribers = [
            self._subscriber("motor_power", MotorPower, self._on_motor_power),
            self._subscriber("reset_odometry", Empty, self._on_reset_odometry),
            # Ignored, but their publishers wait for a subscriber.
            *(self._subscriber(f"led{number}", Led, _ignore) for number in (1, 2)),
            self._subscriber("sound", Sound, _ignore),
        ]

    def close(self) -> None:
        for subscriber in self._subscribers:
            subscriber.unregister()

    def _subscriber(self, topic, kind, callback):
        name = ns_join(self._where, f"commands/{topic}")
        return rospy.Subscriber(name, kind, callback, queue_size=10)

    def _on_motor_power(self, message):
        is_on = message.state == MotorPower.ON
        self._calls.submit(lambda: self._scene.robot(self._name).switch_motors(is_on))

    def _on_reset_odometry(self, _message):
        self._calls.submit(lambda: self._scene.robot(self._name).reset_odometry())


def _ignore(_message):
    pass
