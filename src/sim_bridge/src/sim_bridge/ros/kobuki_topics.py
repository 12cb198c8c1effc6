"""The topics of a Kobuki base below mobile_base (kobuki_gazebo_plugins), but for its velocity."""

from typing import Callable

import rospy
from kobuki_msgs.msg import (
    BumperEvent,
    CliffEvent,
    Led,
    MotorPower,
    SensorState,
    Sound,
    WheelDropEvent,
)
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Empty

from sim_bridge.ros.bumper_cloud import FRAME, BumperCloud
from sim_bridge.ros.orders import Orders
from sim_bridge.scene import Scene
from sim_bridge.sensors.bumper import CENTRE, LEFT, RIGHT
from sim_bridge.sensors.kobuki import KobukiReading

# Bits of SensorState; wheels are numbered otherwise than sectors.
SECTOR_BITS = {RIGHT: 1, CENTRE: 2, LEFT: 4}
WHEEL_BITS = {WheelDropEvent.RIGHT: 1, WheelDropEvent.LEFT: 2}


class KobukiTopics:
    """Events when something changes, the state as often as it is told; commands for motors and odometry.

    ``frame_of`` prefixes a frame's name.
    """

    def __init__(
        self, scene: Scene, name: str, namespace: str, orders: Orders, frame_of: Callable[[str], str]
    ):
        self._scene = scene
        self._name = name
        self._orders = orders
        self._last = KobukiReading()
        self._where = rospy.names.ns_join(namespace, "mobile_base")
        self._frame = frame_of(FRAME)
        self._points = BumperCloud()
        self._bumper, self._cliff, self._drop, self._state, self._cloud = (
            self._publisher(topic, kind)
            for topic, kind in (
                ("events/bumper", BumperEvent),
                ("events/cliff", CliffEvent),
                ("events/wheel_drop", WheelDropEvent),
                ("sensors/core", SensorState),
                ("sensors/bumper_pointcloud", PointCloud2),
            )
        )
        self._subscribers = [
            self._subscriber("commands/motor_power", MotorPower, self._on_motor_power),
            self._subscriber("commands/reset_odometry", Empty, self._on_reset_odometry),
            # There is nothing to light or to sound, but those who do so wait for somebody to listen.
            *(self._subscriber(f"commands/led{number}", Led, _ignore) for number in (1, 2)),
            self._subscriber("commands/sound", Sound, _ignore),
        ]

    def publish(self, reading: KobukiReading, stamp: rospy.Time) -> None:
        last, self._last = self._last, reading
        for sector in sorted(reading.bumpers ^ last.bumpers):
            self._bumper.publish(BumperEvent(bumper=sector, state=sector in reading.bumpers))
        for sector in sorted(reading.cliffs ^ last.cliffs):
            self._cliff.publish(CliffEvent(sensor=sector, state=sector in reading.cliffs))
        for wheel in sorted(reading.dropped ^ last.dropped):
            self._drop.publish(WheelDropEvent(wheel=wheel, state=wheel in reading.dropped))
        if self._state.get_num_connections():
            state = SensorState()
            state.header.stamp, state.header.frame_id = stamp, self._frame
            state.bumper = sum(SECTOR_BITS[sector] for sector in reading.bumpers)
            state.cliff = sum(SECTOR_BITS[sector] for sector in reading.cliffs)
            state.wheel_drop = sum(WHEEL_BITS[wheel] for wheel in reading.dropped)
            self._state.publish(state)
        if self._points.is_due(reading) and self._cloud.get_num_connections():
            self._cloud.publish(self._points.message(reading, stamp, self._frame))

    def close(self) -> None:
        publishers = (self._bumper, self._cliff, self._drop, self._state, self._cloud)
        for connection in (*publishers, *self._subscribers):
            connection.unregister()

    def _publisher(self, topic, kind):
        name = rospy.names.ns_join(self._where, topic)
        return rospy.Publisher(name, kind, queue_size=10, tcp_nodelay=True)

    def _subscriber(self, topic, kind, callback):
        return rospy.Subscriber(rospy.names.ns_join(self._where, topic), kind, callback, queue_size=10)

    def _on_motor_power(self, message):
        is_on = message.state == MotorPower.ON
        self._orders.leave(lambda: self._scene.robot(self._name).switch_motors(is_on))

    def _on_reset_odometry(self, _message):
        self._orders.leave(lambda: self._scene.robot(self._name).reset_odometry())


def _ignore(_message):
    pass
