"""Deprecated: use amcl_lite.sensor.custom_model."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(__name__, {"SensorModel": "amcl_lite.sensor.custom_model:SensorModel"})
