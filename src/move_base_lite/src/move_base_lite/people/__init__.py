"""People, and whatever else moves near the robot."""

from move_base_lite.people.movers import NO_MOVERS, Lookout, Movers

__all__ = ["NO_MOVERS", "Lookout", "Movers"]
