"""Logical time: messages take effect at logical instants (docs/explanation/deterministic_runs.md)."""

from planar_ros.step.step import Step, is_heard_in_step

__all__ = ["Step", "is_heard_in_step"]
