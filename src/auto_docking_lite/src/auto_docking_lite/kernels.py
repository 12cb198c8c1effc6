"""Numba kernels of the dock estimator."""

import math

import numba
import numpy as np

# Half of the widths over which the edges of fans, ranges and receivers are soft [rad, m].
FAN_SOFTNESS, RANGE_SOFTNESS, RECEIVER_SOFTNESS = 0.012, 0.03, 0.06
# Probability of a signal that the model does not expect, and of none where it expects one (hidden dock).
UNEXPECTED, HIDDEN = 0.02, 0.3


@numba.njit(cache=True)
def _soft(margin, softness):
    """Return the probability of being inside an edge, given the distance to it."""
    ratio = margin / softness
    if ratio > 30.0:
        return 1.0
    if ratio < -30.0:
        return 0.0
    return 1.0 / (1.0 + math.exp(-ratio))


@numba.njit(cache=True)
def log_likelihoods(docks, bases, signals, field):
    """Return the log-likelihood (N,) of signals for each pose of a dock.

    Args:
        docks: Poses (N, 3) of the dock.
        bases: Poses (K, 3) of the robot at each signal, in the same frame.
        signals: Bytes (K, 3) of the right, centre and left receiver.
        field: Half angle of the centre fan, of all fans, near range, far range, bearing, half angle and
            radius of the receivers (7,).
    """
    centre_angle, side_angle, near, far, receiver_bearing, receiver_angle, radius = field
    result = np.zeros(docks.shape[0])
    for k in range(bases.shape[0]):
        for receiver in range(3):
            heading = bases[k, 2] + (receiver - 1) * receiver_bearing
            x, y = bases[k, 0] + radius * math.cos(heading), bases[k, 1] + radius * math.sin(heading)
            byte = signals[k, receiver]
            for n in range(docks.shape[0]):
                dx, dy = x - docks[n, 0], y - docks[n, 1]
                distance, direction = math.hypot(dx, dy), math.atan2(dy, dx)
                angle = (direction - docks[n, 2] + math.pi) % (2.0 * math.pi) - math.pi
                incoming = abs((direction - heading) % (2.0 * math.pi) - math.pi)
                visible = (
                    _soft(receiver_angle - incoming, RECEIVER_SOFTNESS)
                    * _soft(side_angle - abs(angle), FAN_SOFTNESS)
                    * _soft(far - distance, RANGE_SOFTNESS)
                )
                if byte == 0:
                    result[n] += math.log(1.0 - (1.0 - HIDDEN) * visible)
                    continue
                centre = _soft(centre_angle - abs(angle), FAN_SOFTNESS)
                left = _soft(angle, FAN_SOFTNESS) * (1.0 - centre)
                right = _soft(-angle, FAN_SOFTNESS) * (1.0 - centre)
                fan = 0.0
                if byte & 10:
                    fan += centre
                if byte & 17:
                    fan += left
                if byte & 36:
                    fan += right
                is_near = _soft(near - distance, RANGE_SOFTNESS)
                side = is_near if byte & 7 else 1.0 - is_near
                result[n] += math.log(UNEXPECTED + (1.0 - UNEXPECTED) * visible * min(fan, 1.0) * side)
    return result
