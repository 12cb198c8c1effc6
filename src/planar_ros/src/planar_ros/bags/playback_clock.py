"""Where in a recording one is, and when what comes next is due."""

import math

FORGIVEN_DELAY = 0.2
"""Wall seconds of delay that are not made up for."""


class PlaybackClock:
    """Moves from ``start`` to ``end``, seconds of the recording, by a wall clock that each call is told.

    ``speed``: times real time, 0 as fast as asked. What is played is told by ``reach``.
    """

    def __init__(self, start: float, end: float, speed: float, wall: float):
        self.start, self.end, self.speed = start, end, speed
        self.is_paused = False
        self.position = start
        self._anchor(wall)

    def delay(self, stamp: float, wall: float) -> float:
        """Wall seconds until what was recorded at ``stamp`` is due; for ever while it is paused."""
        if self.is_paused:
            return math.inf
        if self.speed == 0.0:
            return 0.0
        due = self._anchor_wall + (stamp - self._anchor_stamp) / self.speed
        if wall > due + FORGIVEN_DELAY:
            self._anchor_wall += wall - due
            return 0.0
        return max(0.0, due - wall)

    def advance_to(self, stamp: float) -> None:
        self.position = stamp

    def pause(self, is_paused: bool, wall: float) -> None:
        self.is_paused = is_paused
        self._anchor(wall)

    def set_speed(self, speed: float, wall: float) -> None:
        self.speed = speed
        self._anchor(wall)

    def seek(self, position: float, wall: float) -> None:
        """``position``: seconds since the start; beyond an end it is that end."""
        self.position = min(max(self.start + position, self.start), self.end)
        self._anchor(wall)

    def _anchor(self, wall: float) -> None:
        self._anchor_wall, self._anchor_stamp = wall, self.position
