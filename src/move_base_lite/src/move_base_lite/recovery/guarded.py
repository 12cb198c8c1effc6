"""Stands before a recovery behaviour of other people: what it raises is its own fault."""

from typing import Callable, Optional

from move_base_lite.errors import PluginFailed
from move_base_lite.plugin_guard import PluginGuard
from move_base_lite.recovery.behavior import RecoveryBehavior, RecoveryContext
from planar import Twist2


class GuardedRecovery:
    """A RecoveryBehavior; see there."""

    def __init__(self, name: str, make: Callable[[], RecoveryBehavior]):
        self._guard = PluginGuard(name, make, PluginFailed)

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        with self._guard.watch() as behavior:
            command = behavior.step(context)
            if command is not None:
                self._guard.check_velocity(command)
        return command
