"""Plausibility checks of sensors and wheels."""

from move_base_lite.plausibility.sensor_monitor import SensorMonitor

__all__ = ["SensorMonitor"]
