"""Whether what the sensors tell can be so."""

from move_base_lite.plausibility.sensor_monitor import SensorMonitor

__all__ = ["SensorMonitor"]
