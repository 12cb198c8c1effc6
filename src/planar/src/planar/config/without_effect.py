"""Settings that are accepted and have no effect: parameters, tags and fields of other people's files."""

from dataclasses import dataclass
from typing import Any, Dict, Iterator, Tuple

from planar.config.parameters import DynamicParameter
from planar.errors import SettingsError


class SettingsWithoutEffect:
    """Collects settings that are accepted and have no effect, each once.

    A reader adds what it accepts without effect; at start-up the program logs each setting and the summary,
    or refuses to start if it is strict::

        without_effect.add("/move_base/NavfnROS/planner_window_x", "navfn does not use it either")
        without_effect.add("home.world:12: <audio>", "sound is not simulated")
    """

    def __init__(self) -> None:
        self._texts: Dict[str, str] = {}

    def add(self, name: str, reason: str = "") -> None:
        """Add a setting, unless it has been added already.

        Args:
            name: The setting with its place: namespace of a parameter, ``FILE:LINE: <TAG>`` of a tag.
            reason: Why it has no effect, or what has it instead.
        """
        self._texts.setdefault(name, f"{name} has no effect{': ' if reason else ''}{reason}")

    def __iter__(self) -> Iterator[str]:
        """Iterate over one sentence for each setting."""
        return iter(self._texts.values())

    def __len__(self) -> int:
        return len(self._texts)

    def summary(self, see: str, unknown: int = 0) -> str:
        """Return the line for the start of a program.

        Args:
            see: Where the settings are listed, e.g. ``the lines above``.
            unknown: Number of settings that are not known at all, which count, too.
        """
        count = len(self) + unknown
        return f"{count} setting{'s' * (count != 1)} without effect, see {see}"

    def refuse(self) -> None:
        """Refuse the settings, as a strict program does.

        Raises:
            SettingsError: There are settings without effect; the text lists all of them.
        """
        if self._texts:
            raise SettingsError("\n".join([*self, "remove them, or do without strict"]))


@dataclass(frozen=True)
class IneffectiveParameter(DynamicParameter):
    """Official parameter that is accepted without effect; ``meaning`` is the reason.

    Attributes:
        fulfilled: Values that ask for what happens anyway; ``default`` is one, too.
        is_dynamic: Whether the official dynamic_reconfigure offers it.
    """

    fulfilled: Tuple[Any, ...] = ()
    is_dynamic: bool = True

    def is_fulfilled_by(self, value: Any) -> bool:
        """Whether a value asks for nothing that is not done."""
        return value == self.default or value in self.fulfilled
