"""Deprecated: use amcl_lite.motion.custom_model."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(__name__, {"MotionModel": "amcl_lite.motion.custom_model:MotionModel"})
