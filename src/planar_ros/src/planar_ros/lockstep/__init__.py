"""Lock-step with a simulator: messages are delivered, and take effect, at logical instants (ticks)."""

from planar_ros.lockstep.client import LockstepClient, has_synchronized_publisher

__all__ = ["LockstepClient", "has_synchronized_publisher"]
