"""A control that a person turns, and a program keeps at what somebody else says."""

from typing import Any


class Dial:
    """``handle``: of viser's, with a value.

    Its value is looked at, not waited for: viser sets it at once and calls back later, from another thread,
    when the program may have shown an older one over it.
    """

    def __init__(self, handle: Any):
        self.handle = handle
        self._shown = handle.value

    def is_turned(self) -> bool:
        """By a person, since it was taken or shown. Nobody turns it to NaN, which equals nothing."""
        value = self.handle.value
        return value == value and value != self._shown

    def taken(self) -> Any:
        """What it was turned to."""
        self._shown = self.handle.value
        return self._shown

    def show(self, value: Any) -> None:
        """Unless a person wants something else."""
        if not self.is_turned():
            self._shown = self.handle.value = value
