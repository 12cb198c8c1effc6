"""Clock of bag playback: position, speed, pause and seek."""

import math

FORGIVEN_DELAY = 0.2
"""Delay of the wall clock [s] beyond which playback is not sped up to catch up."""


class PlaybackClock:
    """Maps recorded time to wall-clock time; every call takes the current wall-clock time.

    Args:
        start: Start of the recording [s].
        end: End of the recording [s].
        speed: Playback rate as a multiple of real time; 0 plays without delays.
        wall: Wall-clock time [s].

    Attributes:
        position: Recorded time of playback [s], between ``start`` and ``end``.
        is_paused: Whether playback is paused.
    """

    def __init__(self, start: float, end: float, speed: float, wall: float):
        self.start, self.end, self.speed = start, end, speed
        self.is_paused = False
        self.position = start
        self._anchor(wall)

    def delay(self, stamp: float, wall: float) -> float:
        """Return how long to wait before playing a message.

        Args:
            stamp: Time at which the message was recorded [s].
            wall: Wall-clock time [s].

        Returns:
            Wall-clock delay [s]; infinity while paused.
        """
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
        """Set the position after playing the messages up to ``stamp`` [s]."""
        self.position = stamp

    def pause(self, is_paused: bool, wall: float) -> None:
        """Pause or resume playback at wall-clock time ``wall`` [s]."""
        self.is_paused = is_paused
        self._anchor(wall)

    def set_speed(self, speed: float, wall: float) -> None:
        """Change the playback rate at wall-clock time ``wall`` [s]."""
        self.speed = speed
        self._anchor(wall)

    def seek(self, position: float, wall: float) -> None:
        """Jump to a position, clamped to the recording.

        Args:
            position: Time since the start of the recording [s].
            wall: Wall-clock time [s].
        """
        self.position = min(max(self.start + position, self.start), self.end)
        self._anchor(wall)

    def _anchor(self, wall: float) -> None:
        self._anchor_wall, self._anchor_stamp = wall, self.position
