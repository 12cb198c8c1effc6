"""TITLE: a recovery behaviour for move_base_lite."""

from dataclasses import dataclass
from typing import Optional

from move_base_lite import RecoveryContext, RecoverySettings
from planar import Twist2
from planar.config.parameters import POSITIVE, parameter


@dataclass(frozen=True)
class Settings(RecoverySettings):
    """Parameters, read from the behaviour's namespace (its name in ``recovery_behaviors``)."""

    seconds: float = parameter(2.0, "time to wait", "s", POSITIVE)


class CLASS:
    """Waits for a dynamic obstacle to leave."""

    Settings = Settings

    def __init__(self, settings: Settings):
        self._remaining = settings.seconds

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """See move_base_lite.RecoveryBehavior; returns the velocity, None at the end."""
        self._remaining -= context.period
        return Twist2() if self._remaining > 0.0 else None
