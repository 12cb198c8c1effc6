"""Whether move_base's sensors can be trusted, on /diagnostics."""

from typing import Optional

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

PERIOD = 1.0
WELL = "what the sensors tell can be so"


class SensorDiagnostics:
    """Tells once a second, and at once when it changes."""

    def __init__(self) -> None:
        self._publisher = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=10)
        self._told: Optional[str] = None
        self._told_at = rospy.Time(0)

    def tell(self, fault: Optional[str], now: rospy.Time) -> None:
        """``complaint``: which sensor cannot be trusted and why; None if all can."""
        is_old = abs((now - self._told_at).to_sec()) >= PERIOD
        if fault == self._told and not is_old:
            return
        self._told, self._told_at = fault, now
        level = DiagnosticStatus.OK if fault is None else DiagnosticStatus.ERROR
        name, sensor = rospy.get_name().lstrip("/"), (fault or "").partition(":")[0]
        status = DiagnosticStatus(level, f"{name}: sensors", fault or WELL, sensor, [])
        message = DiagnosticArray(status=[status])
        message.header.stamp = now
        self._publisher.publish(message)
