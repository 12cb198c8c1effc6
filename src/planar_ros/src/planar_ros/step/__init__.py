"""Logical time: messages take effect at logical instants (docs/explanation/deterministic_runs.md)."""

from planar.deprecation import deprecated_names
from planar_ros.step.step import LockstepClient, has_synchronised_publisher

__all__ = ["LockstepClient", "has_synchronised_publisher"]

__getattr__ = deprecated_names(__name__, {"Step": "LockstepClient"})
