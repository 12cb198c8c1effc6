"""Logical time: messages are taken in, and take effect, at moments (docs/explanation/deterministic_runs.md)."""

from planar_ros.step.step import Step, is_heard_in_step

__all__ = ["Step", "is_heard_in_step"]
