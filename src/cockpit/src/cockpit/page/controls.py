"""Which values a control of the page can have: of its kind, of its options, between its bounds.

viser takes whatever it is sent: it makes the text "nan" into the number of a slider, and sends all pages an
integer that no message can hold, which is the end of each of their connections.
"""

from typing import Any

LARGEST_WHOLE = 1 << 53  # JavaScript's


def can_have(control: Any, value: Any) -> bool:
    """``control``: a handle of viser's with a value; ``value``: finite, as it was decoded."""
    kind = type(control.value)
    if kind is int or kind is float:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return is_number and (kind is float or abs(value) <= LARGEST_WHOLE) and _is_between(control, value)
    if kind is str:
        return isinstance(value, str) and value in getattr(control, "options", (value,))
    return type(value) is kind


def _is_between(control: Any, value: float) -> bool:
    """The page rounds to steps, so that the last may lie beyond."""
    least, most = getattr(control, "min", None), getattr(control, "max", None)
    step = getattr(control, "step", 0.0)
    return (least is None or value >= least - step) and (most is None or value <= most + step)
