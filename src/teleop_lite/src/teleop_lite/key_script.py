"""Keys held for a while, written as text: ``i:2.0 j:1.5``."""

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
    """A text is not a script of keys; the error shows the part that is not."""


@dataclass(frozen=True)
class Stroke:
    """A key held for ``seconds``; 0 is a single press."""

    key: str
    seconds: float = 0.0


def parse(text: str, keys: Collection[str] = KEYS) -> List[Stroke]:
    """The strokes of a script such as ``i:2.0 j:1.5``, separated by blanks, newlines or commas.

    A key without a time (``q``) is pressed once. ``keys``: those there are. Raises KeyScriptError.
    """
    strokes = []
    position = SEPARATORS.match(text).end()  # type: ignore[union-attr]
    while position < len(text):
        match = STROKE.match(text, position)
        key = (match["key"] or match["tap"]) if match else ""
        if not match or key not in keys:
            raise KeyScriptError(f"'{text[position:].split()[0]}' is not a key with a time, such as i:2.0")
        strokes.append(Stroke(key, float(match["seconds"] or 0.0)))
        position = SEPARATORS.match(text, match.end()).end()  # type: ignore[union-attr]
    return strokes


class KeyScript:
    """Strokes played one after the other; more may be added while they are."""

    def __init__(self, strokes: List[Stroke]):
        self._strokes: Deque[Stroke] = deque(strokes)
        self._held_since: Optional[float] = None

    def add(self, strokes: List[Stroke]) -> None:
        """Puts strokes behind those that are still to be played."""
        self._strokes.extend(strokes)

    @property
    def is_over(self) -> bool:
        return not self._strokes

    def keys_at(self, now: float) -> str:
        """The keys down at a time, seconds, which must not decrease; empty when there is nothing left."""
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
