"""Ways of driving to be tried: speeds and turn rates over time."""

from typing import List

import numpy as np

from move_base_lite.control.mppi.settings import MppiSettings

# Points in time at which the speeds of a sample are drawn; between them they change evenly.
KNOTS = 5
# Share of the time that the first of two arcs takes.
FIRST = 1.0 / 3.0


def smooth_noise(rng: np.random.Generator, settings: MppiSettings, steps: int) -> np.ndarray:
    """Deviations (samples, steps, 2) of speed and turn rate; the first is none."""
    knots = rng.standard_normal((settings.samples, KNOTS, 2))
    knots *= (settings.noise_vel_x, settings.noise_vel_theta)
    knots[0] = 0.0
    at = np.linspace(0.0, KNOTS - 1.0, steps)
    before = np.minimum(at.astype(int), KNOTS - 2)
    share = (at - before)[None, :, None]
    return (1.0 - share) * knots[:, before] + share * knots[:, before + 1]


def fan(settings: MppiSettings, steps: int) -> np.ndarray:
    """Ways (N, steps, 2) that a stuck mean would not come upon: arcs at some speeds, ahead and back."""
    speeds = [settings.max_vel_x, 0.5 * settings.max_vel_x, settings.creep_vel_x, 0.0, settings.min_vel_x]
    rates = np.linspace(-settings.max_vel_theta, settings.max_vel_theta, 11)
    return np.repeat(_arcs(speeds, rates)[:, None, :], steps, axis=1)


def evasions(settings: MppiSettings, steps: int) -> np.ndarray:
    """Ways (N, steps, 2) that let something pass and then go on, or get out of its way and then stop: every
    two of some arcs, one after the other.
    """
    speeds = [settings.max_vel_x, 0.0, settings.min_vel_x]
    rates = settings.max_vel_theta * np.array([-1.0, -0.3, 0.0, 0.3, 1.0])
    arcs = _arcs(speeds, rates)
    first, second = (~np.eye(len(arcs), dtype=bool)).nonzero()
    is_first = (np.arange(steps) < steps * FIRST)[None, :, None]
    return np.where(is_first, arcs[first, None], arcs[second, None])


def _arcs(speeds: List[float], rates: np.ndarray) -> np.ndarray:
    """Every speed with every turn rate, (N, 2)."""
    return np.array([(v, omega) for v in speeds for omega in rates])
