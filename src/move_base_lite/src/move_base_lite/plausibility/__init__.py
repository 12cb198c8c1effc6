"""Whether what the sensors tell can be so."""

from move_base_lite.plausibility.sensor_watch import SensorWatch

__all__ = ["SensorWatch"]
