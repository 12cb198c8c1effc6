"""Scripts of keys and their durations: ``i:2.0 j:1.5``."""

import re
from collections import deque
from dataclasses import dataclass
from typing import Collection, Deque, List, Optional

from planar import PlanarError
from teleop_lite.teleop import MOVE_KEYS, SPEED_KEYS, STOP_KEYS

# A comma is a separator unless a colon follows: then it is the key for going back.
STROKE = re.compile(r"(?P<key>[^\s:]):(?P<seconds>\d+(\.\d*)?|\.\d+)(?=[\s,]|$)|(?P<tap>[^\s,:])(?=[\s,]|$)")
SEPARATORS = re.compile(r"(\s|,(?!:))*")
KEYS = {*MOVE_KEYS, *SPEED_KEYS, *STOP_KEYS}
TIME_TOLERANCE = 1e-6


class KeyScriptError(PlanarError):
    """A text is not a key script; the message shows the invalid part."""


@dataclass(frozen=True)
class KeyStroke:
    """A key that is pressed or held.

    Attributes:
        key: The key.
        seconds: Duration [s]; 0 for a key that is pressed once.
    """

    key: str
    seconds: float = 0.0


def parse(text: str, keys: Collection[str] = KEYS) -> List[KeyStroke]:
    """Parse a script such as ``i:2.0 j:1.5``, separated by blanks, newlines or commas.

    Args:
        text: The script, durations in seconds; a key without a duration (``q``) is pressed once.
        keys: The valid keys.

    Raises:
        KeyScriptError: A part of the text is not a key with a duration.
    """
    strokes = []
    position = SEPARATORS.match(text).end()  # type: ignore[union-attr]
    while position < len(text):
        match = STROKE.match(text, position)
        key = (match["key"] or match["tap"]) if match else ""
        if not match or key not in keys:
            raise KeyScriptError(f"'{text[position:].split()[0]}' is not a key with a time, such as i:2.0")
        strokes.append(KeyStroke(key, float(match["seconds"] or 0.0)))
        position = SEPARATORS.match(text, match.end()).end()  # type: ignore[union-attr]
    return strokes


class KeyScript:
    """A queue of key strokes that are executed one after the other."""

    def __init__(self, strokes: List[KeyStroke]):
        self._strokes: Deque[KeyStroke] = deque(strokes)
        self._held_since: Optional[float] = None

    def add(self, strokes: List[KeyStroke]) -> None:
        """Append key strokes."""
        self._strokes.extend(strokes)

    @property
    def is_over(self) -> bool:
        return not self._strokes

    def keys_at(self, now: float) -> str:
        """Return the keys that are down at a time; empty at the end.

        Args:
            now: Time [s], which must not decrease between calls.
        """
        keys = ""
        start = now if self._held_since is None else self._held_since
        while self._strokes:
            stroke = self._strokes[0]
            if now < start + stroke.seconds - TIME_TOLERANCE:
                self._held_since = start
                return keys + stroke.key
            self._strokes.popleft()
            start += stroke.seconds
            if stroke.seconds == 0.0:
                keys += stroke.key
        self._held_since = None
        return keys
