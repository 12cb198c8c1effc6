"""Logical time: messages are taken in, and take effect, at moments (docs/logical_time.md)."""

from planar.deprecation import deprecated_names
from planar_ros.step.step import LockstepClient, has_synchronised_publisher

__all__ = ["LockstepClient", "has_synchronised_publisher"]

__getattr__ = deprecated_names(__name__, {"Step": "LockstepClient"})
