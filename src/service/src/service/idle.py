"""Idle time of the service's robot."""

# Idle time that is worthwhile to be skipped [s].
SHORTEST_IDLE = 3.0


def idle_until(now: float, is_moving: bool, *due: float) -> float:
    """Return until when the robot stands and nothing is due [s]; ``now`` if that is not for some seconds.

    Args:
        now: Time [s].
        is_moving: Whether an order is under way that moves the robot.
        due: Times at which something has to be done [s].
    """
    until = now if is_moving else min(due)
    return until if until - now >= SHORTEST_IDLE else now
