"""Settings that are accepted and have no effect: parameters, tags and fields of other people's files."""

from dataclasses import dataclass
from typing import Any, Dict, Iterator, Sequence, Tuple, Type

from planar.config.parameters import DynamicParameter
from planar.errors import PlanarError, SettingsError


def summary(count: int, strict: str) -> str:
    """Return the line that follows the names of settings without effect in a log.

    Args:
        count: Number of settings.
        strict: Parameter or option that makes an error of them.
    """
    settings = f"{count} setting{'s' * (count != 1)}"
    return f"{settings} without effect, see the lines above; {strict} makes this an error"


def refuse(texts: Sequence[str], error: Type[PlanarError] = SettingsError) -> None:
    """Refuse settings without effect, as a strict program does.

    Args:
        texts: One sentence for each setting.
        error: Class of the error.

    Raises:
        PlanarError: Of the class ``error``, if there are any; the text lists all of them.
    """
    if texts:
        raise error("\n".join([*texts, "remove what has no effect, or do without strict"]))


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
