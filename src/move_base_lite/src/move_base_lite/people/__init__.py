"""People, and whatever else moves near the robot."""

from move_base_lite.people.movers import NO_MOVERS, Movers

__all__ = ["NO_MOVERS", "Movers"]
