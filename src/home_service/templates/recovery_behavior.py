"""TITLE: a recovery behaviour for move_base_lite."""

from dataclasses import dataclass
from typing import Optional

from move_base_lite import RecoveryContext, RecoverySettings
from planar import Twist2
from planar.config.parameters import POSITIVE, parameter


@dataclass(frozen=True)
class Settings(RecoverySettings):
    """Parameters of its own; in the namespace that recovery_behaviors names."""

    seconds: float = parameter(2.0, "how long to wait", "s", POSITIVE)


class CLASS:
    """Waits: what is in the way may go."""

    Settings = Settings

    def __init__(self, settings: Settings):
        self._left = settings.seconds

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """See move_base_lite.RecoveryBehavior: the velocity, None at the end."""
        self._left -= context.period
        return Twist2() if self._left > 0.0 else None
