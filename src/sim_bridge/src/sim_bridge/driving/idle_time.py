"""Idle time: how long it lasts, and how many of its steps are skipped."""

import math

# Simulated time before the end of an idle time in which sensors measure again, each at least once [s].
LAST_SECONDS = 1.0
# Shortest and longest idle time between two ticks of nodes [simulated s].
SHORTEST_SECONDS, LONGEST_SECONDS = 3.0, 60.0
# Share of a period by which a time may be short of a tick.
ROUNDING = 1e-6


def idle_seconds(stamp: float, until: float, period: float) -> float:
    """Return how long an idle time lasts that begins at a tick [s]; 0 if it is not worthwhile.

    Args:
        stamp: Time of the tick [s].
        until: Time at which something is due [s].
        period: Time between two ticks [s].

    Returns:
        Whole periods, so that it ends at a tick.
    """
    seconds = math.floor(min(until - stamp, LONGEST_SECONDS) / period + ROUNDING) * period
    return seconds if seconds >= SHORTEST_SECONDS else 0.0


def last_steps(step_seconds: float) -> int:
    """Return how many steps are taken at the end of an idle time, so that sensors measure.

    Args:
        step_seconds: Duration of a step [s].
    """
    return math.ceil(LAST_SECONDS / step_seconds - ROUNDING)
