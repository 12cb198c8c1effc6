"""How large a number may be to mean anything to a robot: what is beyond is refused where it comes in."""

from planar.errors import PlanarError

# Metres from an origin: cells of a hundredth of a millimetre are still told apart there.
MAX_COORDINATE = 1e6
# Radians: many turns, of which sines and cosines are still exact.
MAX_ANGLE = 1e4
# m/s and rad/s.
MAX_SPEED = 1e3
MAX_BEAMS = 100_000
MIN_RESOLUTION, MAX_RESOLUTION = 1e-4, 1e4


class OutOfRangeError(PlanarError):
    """A number is not finite, or larger than anything a robot meets; the text names it."""


def is_within(limit: float, *values: float) -> bool:
    """Whether all values lie in [-limit, limit]; NaN lies nowhere."""
    return all(-limit <= value <= limit for value in values)


def check_within(limit: float, what: str, **values: float) -> None:
    """Raises OutOfRangeError that ``what``, e.g. "a scan", has a value beyond ``limit``."""
    for name, value in values.items():
        if not -limit <= value <= limit:  # nor is NaN
            raise OutOfRangeError(f"{what} with {name} {value:g} means nothing")
