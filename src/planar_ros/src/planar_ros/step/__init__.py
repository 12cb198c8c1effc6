"""Deprecated: use planar_ros.lockstep."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(__name__, {"Step": "planar_ros.lockstep:LockstepClient"})
