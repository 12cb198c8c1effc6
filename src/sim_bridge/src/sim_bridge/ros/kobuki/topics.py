"""Topics of the sensors of a Kobuki base, below mobile_base (kobuki_gazebo_plugins)."""

import rospy
from kobuki_msgs.msg import BumperEvent, CliffEvent, SensorState, WheelDropEvent
from sensor_msgs.msg import PointCloud2

from sim_bridge.power.system import PowerReading
from sim_bridge.ros.kobuki.bumper_cloud import FRAME, BumperCloud
from sim_bridge.ros.publishers import RobotPublishers
from sim_bridge.sensors.kobuki import SECTOR_BITS, KobukiProfile, KobukiReading

NAMESPACE = "mobile_base"
# Bits of SensorState; wheels have other numbers than sectors.
WHEEL_BITS = {WheelDropEvent.RIGHT: 1, WheelDropEvent.LEFT: 2}


class KobukiTopics:
    """Publishes events when a sensor changes, and the state at each reading."""

    def __init__(self, _profile: KobukiProfile, publishers: RobotPublishers):
        self._last = KobukiReading()
        self._frame = publishers.frame(FRAME)
        self._points = BumperCloud()
        self._bumper, self._cliff, self._drop, self._state, self._cloud = self._all = [
            publishers.publisher(f"{NAMESPACE}/{topic}", kind)
            for topic, kind in (
                ("events/bumper", BumperEvent),
                ("events/cliff", CliffEvent),
                ("events/wheel_drop", WheelDropEvent),
                ("sensors/core", SensorState),
                ("sensors/bumper_pointcloud", PointCloud2),
            )
        ]

    def has_subscribers(self) -> bool:
        return any(publisher.get_num_connections() for publisher in self._all)

    def publish(self, reading: KobukiReading, stamp: rospy.Time) -> None:
        """Publish events of changes, the state, and the cloud of the bumper.

        Args:
            reading: State of the sensors.
            stamp: Time of the measurement.
        """
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
            if reading.power is not None:
                _fill_power(state, reading.power)
            self._state.publish(state)
        if self._points.is_due(reading) and self._cloud.get_num_connections():
            self._cloud.publish(self._points.message(reading, stamp, self._frame))


def _fill_power(state: SensorState, power: PowerReading) -> None:
    """Set battery [0.1 V], charger and motor currents [10 mA] of a state."""
    state.battery, state.charger = round(power.voltage * 10.0), int(power.charger)
    state.current = [min(round(current * 100.0), 255) for current in power.motor_currents]
