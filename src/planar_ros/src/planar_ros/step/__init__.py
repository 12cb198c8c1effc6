"""Logical time: messages are taken in, and take effect, at moments (docs/logical_time.md)."""

from planar_ros.step.step import Step

__all__ = ["Step"]
