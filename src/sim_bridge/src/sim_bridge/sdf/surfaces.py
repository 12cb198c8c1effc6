"""Reads <surface> and <velocity_decay> elements."""

import math
from typing import Tuple

from sim_bridge.sdf.element import Element
from sim_bridge.sdf.warnings import SkippedElements
from sim_bridge.world import SurfaceProperties

# Largest fraction of a velocity that is lost in a step.
MAX_DECAY = 1.0 - 1e-9


def read_surface(collision: Element, warnings: SkippedElements) -> SurfaceProperties:
    """Read the surface of a collision.

    Args:
        collision: The <collision>.
        warnings: Receives a warning if friction depends on the direction; the smaller coefficient is used.
    """
    surface = collision.child("surface")
    if surface is None:
        return SurfaceProperties()
    friction, ode = 1.0, surface.child("friction", "ode")
    if ode is not None:
        mu, mu2 = ode.number("mu", default=1.0), ode.number("mu2", default=1.0)
        friction = max(min(mu, mu2), 0.0)
        if mu != mu2 and friction < 1.0:
            warnings.skip(
                ode, f"mu {mu:g} and mu2 {mu2:g} differ: the smaller one acts in all directions", "mu2"
            )
    bounce = surface.child("bounce")
    if bounce is None:
        return SurfaceProperties(friction)
    threshold = bounce.child("threshold")
    return SurfaceProperties(
        friction,
        min(max(bounce.number("restitution_coefficient", default=0.0), 0.0), 1.0),
        max(threshold.numbers(1)[0], 0.0) if threshold is not None else None,
    )


def read_damping(link: Element, step: float) -> Tuple[float, float]:
    """Return the damping of the linear and angular velocity of a link [1/s].

    Args:
        link: The <link>; its <velocity_decay> is the fraction of the velocity that ODE removes in each step.
        step: Step of Gazebo's physics [s].
    """
    decay = link.child("velocity_decay")
    if decay is None:
        return 0.0, 0.0
    lost = (min(max(decay.number(kind, default=0.0), 0.0), MAX_DECAY) for kind in ("linear", "angular"))
    linear, angular = (-math.log1p(-share) / step for share in lost)
    return linear, angular
