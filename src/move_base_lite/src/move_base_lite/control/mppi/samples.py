"""Control sequences to be evaluated: speeds and turn rates over time."""

from typing import List

import numpy as np

from move_base_lite.control.mppi.settings import MppiSettings

# Points in time at which noise is drawn; it is interpolated linearly between them.
KNOTS = 5
# Share of the horizon that the first arc of an evasive sequence takes.
FIRST_ARC_SHARE = 1.0 / 3.0


def smooth_noise(rng: np.random.Generator, settings: MppiSettings, steps: int) -> np.ndarray:
    """Draw smooth deviations of speed and turn rate.

    Args:
        rng: Random number generator.
        settings: Number of samples and standard deviations.
        steps: Control periods of the horizon.

    Returns:
        Noise (samples, steps, 2) [m/s, rad/s]; the first sample is zero.
    """
    knots = rng.standard_normal((settings.samples, KNOTS, 2))
    knots *= (settings.noise_vel_x, settings.noise_vel_theta)
    knots[0] = 0.0
    at = np.linspace(0.0, KNOTS - 1.0, steps)
    before = np.minimum(at.astype(int), KNOTS - 2)
    share = (at - before)[None, :, None]
    return (1.0 - share) * knots[:, before] + share * knots[:, before + 1]


def arc_controls(settings: MppiSettings, steps: int) -> np.ndarray:
    """Create constant controls, forward and backward: an escape from a local minimum of the mean.

    Args:
        settings: Limits of speed and turn rate.
        steps: Control periods of the horizon.

    Returns:
        Controls (N, steps, 2) [m/s, rad/s].
    """
    speeds = [settings.max_vel_x, 0.5 * settings.max_vel_x, settings.creep_vel_x, 0.0, settings.min_vel_x]
    rates = np.linspace(-settings.max_vel_theta, settings.max_vel_theta, 11)
    return np.repeat(_arcs(speeds, rates)[:, None, :], steps, axis=1)


def evasive_controls(settings: MppiSettings, steps: int) -> np.ndarray:
    """Create controls of two different arcs: wait and then continue, or evade and then stop.

    Args:
        settings: Limits of speed and turn rate.
        steps: Control periods of the horizon.

    Returns:
        Controls (N, steps, 2) [m/s, rad/s].
    """
    speeds = [settings.max_vel_x, 0.0, settings.min_vel_x]
    rates = settings.max_vel_theta * np.array([-1.0, -0.3, 0.0, 0.3, 1.0])
    arcs = _arcs(speeds, rates)
    first, second = (~np.eye(len(arcs), dtype=bool)).nonzero()
    is_first = (np.arange(steps) < steps * FIRST_ARC_SHARE)[None, :, None]
    return np.where(is_first, arcs[first, None], arcs[second, None])


def _arcs(speeds: List[float], rates: np.ndarray) -> np.ndarray:
    """Every speed with every turn rate, (N, 2)."""
    return np.array([(v, omega) for v in speeds for omega in rates])
