"""How long driving takes, learnt on the way."""

from typing import Optional

from planar import Pose2

FIRST_PACE = 0.3
DETOUR = 1.3
"""A way in a home is about so much longer than the straight line."""


class Forecast:
    """Estimates driving times from straight distances and the pace so far, metres per second."""

    def __init__(self, pace: float = FIRST_PACE):
        self._first_pace = pace
        self._metres = self._seconds = 0.0
        self._set_out_at: Optional[float] = None
        self._metres_ahead = 0.0

    def seconds_between(self, start: Pose2, end: Pose2) -> float:
        return DETOUR * start.distance_to(end) / self._pace

    def set_out(self, now: float, start: Optional[Pose2], end: Pose2) -> None:
        """The robot leaves ``start``, if that is known, for ``end``."""
        self._set_out_at = now
        self._metres_ahead = DETOUR * start.distance_to(end) if start else 0.0

    def arrive(self, now: float) -> None:
        if self._set_out_at is not None and self._metres_ahead > 0.0:
            self._metres += self._metres_ahead
            self._seconds += now - self._set_out_at
        self._set_out_at = None

    def seconds_left(self, now: float) -> float:
        """Of the way that the robot is on."""
        if self._set_out_at is None:
            return 0.0
        return max(0.0, self._metres_ahead / self._pace - (now - self._set_out_at))

    @property
    def _pace(self) -> float:
        """The pace so far, of which little driving says little."""
        prior_seconds = 10.0
        metres = self._metres + prior_seconds * self._first_pace
        return metres / (self._seconds + prior_seconds)
