"""Limits of plausible numbers; values beyond them are refused where they enter the program."""

from planar.errors import OutOfRangeError

# Metres from the origin; coordinates up to here still resolve 0.01 mm.
MAX_COORDINATE = 1e6
# Radians; sines and cosines are still exact up to here.
MAX_ANGLE = 1e4
# m/s and rad/s.
MAX_SPEED = 1e3
MAX_BEAMS = 100_000
MIN_RESOLUTION, MAX_RESOLUTION = 1e-4, 1e4


def is_within(limit: float, *values: float) -> bool:
    """Return whether all values are in [-limit, limit]; False for NaN."""
    return all(-limit <= value <= limit for value in values)


def check_within(limit: float, what: str, **values: float) -> None:
    """Check values against a limit.

    Args:
        limit: Largest valid absolute value.
        what: Name of the object with article, e.g. ``a scan``.
        values: Values by name.

    Raises:
        OutOfRangeError: For the first value that is NaN or beyond the limit.
    """
    for name, value in values.items():
        if not -limit <= value <= limit:  # true for NaN as well
            raise OutOfRangeError(f"{what} with invalid {name} {value:g}")
