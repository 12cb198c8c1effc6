"""Sensor status of move_base on /diagnostics."""

from typing import Optional

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

PERIOD = 1.0
OK_TEXT = "sensor data are plausible"


class SensorDiagnostics:
    """Publishes the status once a second, and at once when it changes."""

    def __init__(self) -> None:
        self._publisher = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=10)
        self._published: Optional[str] = None
        self._published_at = rospy.Time(0)

    def publish(self, fault: Optional[str], now: rospy.Time) -> None:
        """Publish the status if it has changed or is due.

        Args:
            fault: Sensor and reason, as from SensorMonitor.fault; None if there is no fault.
            now: Stamp.
        """
        is_old = abs((now - self._published_at).to_sec()) >= PERIOD
        if fault == self._published and not is_old:
            return
        self._published, self._published_at = fault, now
        level = DiagnosticStatus.OK if fault is None else DiagnosticStatus.ERROR
        name, sensor = rospy.get_name().lstrip("/"), (fault or "").partition(":")[0]
        status = DiagnosticStatus(level, f"{name}: sensors", fault or OK_TEXT, sensor, [])
        message = DiagnosticArray(status=[status])
        message.header.stamp = now
        self._publisher.publish(message)
