"""Registry of recovery behaviours; to add a behaviour, add it to RECOVERIES."""

from typing import Callable, Optional

from move_base_lite.errors import PluginFailed
from move_base_lite.plugin import Registry
from move_base_lite.plugin_guard import PluginGuard
from move_base_lite.recovery.behavior import RecoveryBehavior, RecoveryContext, RecoverySettings
from move_base_lite.recovery.clear_costmap import CLEAR_COSTMAP
from move_base_lite.recovery.move_slow import MOVE_SLOW
from move_base_lite.recovery.rotate import ROTATE
from planar import Twist2
from planar.plugins import PluginContract


class GuardedRecovery:
    """Wraps a user-defined recovery behaviour; an error in it becomes PluginFailed with its name.

    Args:
        name: Name of the plugin, for messages.
        make: Constructs the behaviour.
    """

    def __init__(self, name: str, make: Callable[[], RecoveryBehavior]):
        self._guard = PluginGuard(name, make, PluginFailed)

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """Call the wrapped behaviour (see RecoveryBehavior.step).

        Raises:
            PluginFailed: The behaviour raised, took too long or returned a velocity that is not finite.
        """
        with self._guard.watch() as behavior:
            command = behavior.step(context)
            if command is not None:
                self._guard.check_velocity(command)
        return command


RECOVERIES: Registry[RecoveryBehavior] = Registry(
    CLEAR_COSTMAP,
    ROTATE,
    MOVE_SLOW,
    contract=PluginContract(
        "recovery behaviour", RecoveryBehavior, RecoverySettings, "move_base_lite.recovery_behaviors"
    ),
    guarded=GuardedRecovery,
)
