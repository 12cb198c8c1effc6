"""Deprecated name of sim_bridge.sensors.element."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(
    __name__,
    {
        "Found": "sim_bridge.sensors.element:SensorElement",
        "namespace_of": "sim_bridge.sensors.element:namespace_of",
    },
)
