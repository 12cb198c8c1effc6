"""Log lines about what has no effect."""

from typing import Sequence

import rospy

from sim_bridge.sdf.warnings import refuse


def log_warnings(warnings: Sequence[str], strict: bool = False) -> None:
    """Log warnings about worlds, models and robots, with their number.

    Args:
        warnings: The warnings.
        strict: Treat them as errors.

    Raises:
        WorldError: There are warnings, and they are errors.
    """
    refuse(warnings, strict)
    for warning in warnings:
        rospy.logwarn("%s", warning)
    if warnings:
        count = f"{len(warnings)} setting{'s' * (len(warnings) != 1)}"
        rospy.logwarn("%s without effect, see the lines above; ~strict makes this an error", count)
