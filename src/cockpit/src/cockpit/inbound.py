"""Checks of messages from browsers: allowed kinds, finite numbers, message rate."""

import math
from typing import Any, Mapping

from cockpit.errors import RefusedError

LARGEST_MESSAGE = 256 * 1024
# A page sends its camera 60 times a second while it turns, and drags in addition.
MESSAGES_PER_SECOND, BURST = 240.0, 960.0
DEEPEST = 8

# The messages of the controls that this page has. Others that viser accepts (files, forms, sharing, pictures)
# are rejected: viser keeps some of them forever.
KINDS = frozenset(
    {
        "ViewerCameraMessage",
        "GuiUpdateMessage",
        "GuiButtonHoldMessage",
        "CommandTriggerMessage",
        "SceneNodeClickMessage",
        "SceneNodeDragMessage",
        "ScenePointerMessage",
    }
)


class RateLimiter:
    """Token bucket that limits the message rate.

    Args:
        rate: Long-term limit [messages/s].
        burst: Number of messages that are allowed at once.
    """

    def __init__(self, rate: float = MESSAGES_PER_SECOND, burst: float = BURST):
        self._rate, self._burst = rate, burst
        self._left = burst
        self._at = -math.inf

    def allow(self, now: float) -> bool:
        """Return whether a message is allowed.

        Args:
            now: Steady-clock time [s].
        """
        self._left = min(self._burst, self._left + (now - self._at) * self._rate)
        self._at = now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True


def check(message: Any) -> None:
    """Check a decoded message.

    Raises:
        RefusedError: The page never sends such a message.
    """
    if not isinstance(message, Mapping) or message.get("type") not in KINDS:
        raise RefusedError("not a message that the page sends")
    updates = message.get("updates", {})
    if not isinstance(updates, Mapping) or set(updates) - {"value"}:
        raise RefusedError("changes more than a value")
    _check_value(message, DEEPEST)


def _check_value(value: Any, depth: int) -> None:
    if depth == 0:
        raise RefusedError("nested too deeply")
    if isinstance(value, float) and not math.isfinite(value):
        raise RefusedError("a number is not finite")
    if isinstance(value, Mapping):
        value = list(value.values())
    if isinstance(value, (list, tuple)):
        for item in value:
            _check_value(item, depth - 1)
