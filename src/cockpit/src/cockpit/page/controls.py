"""Controls of the page: which values one accepts, and controls that both a person and the program set.

viser accepts any value a browser sends: the text "nan" becomes the number of a slider, and an integer
that does not fit into a message is sent to all pages, which closes their connections. So ``accepts`` checks.
"""

from typing import Any

LARGEST_WHOLE = 1 << 53  # JavaScript's


def accepts(control: Any, value: Any) -> bool:
    """Check whether a value has the control's type, is one of its options and lies between its bounds.

    Args:
        control: A handle of viser with a value.
        value: A decoded, finite value that a browser has sent for it.
    """
    kind = type(control.value)
    if kind is int or kind is float:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return is_number and (kind is float or abs(value) <= LARGEST_WHOLE) and _is_between(control, value)
    if kind is str:
        return isinstance(value, str) and value in getattr(control, "options", (value,))
    return type(value) is kind


def _is_between(control: Any, value: float) -> bool:
    """The page rounds to steps, so the last step may exceed the bound."""
    least, most = getattr(control, "min", None), getattr(control, "max", None)
    step = getattr(control, "step", 0.0)
    return (least is None or value >= least - step) and (most is None or value <= most + step)


class TwoWayControl:
    """A control whose value a person changes and the program keeps equal to a remote value.

    The value is polled: viser sets it at once but calls back later, from another thread, when the program may
    have overwritten it with an older one.

    Attributes:
        handle: The handle of viser, which has a ``value``.
    """

    def __init__(self, handle: Any):
        self.handle = handle
        self._shown = handle.value

    def is_changed(self) -> bool:
        """Return whether a person has changed the value since it was consumed or shown (NaN is ignored)."""
        value = self.handle.value
        return value == value and value != self._shown

    def consume(self) -> Any:
        """Return the value that a person has set, and mark it as handled."""
        self._shown = self.handle.value
        return self._shown

    def show(self, value: Any) -> None:
        """Display a remote value, unless a person's change has not been handled yet."""
        if not self.is_changed():
            self._shown = self.handle.value = value
