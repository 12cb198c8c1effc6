"""The local planners that there are. To add one is to add it here."""

from move_base_lite.control.dwa import DWA, TRAJECTORY
from move_base_lite.control.guarded import GuardedLocalPlanner
from move_base_lite.control.local_planner import LocalPlanner
from move_base_lite.control.mppi import MPPI
from move_base_lite.control.settings import ControllerSettings
from move_base_lite.plugin import Registry
from planar import SettingsError
from planar.config.hints import hint_or_choices
from planar.plugins import PluginContract

LOCAL_PLANNERS: Registry[LocalPlanner] = Registry(
    TRAJECTORY,
    DWA,
    MPPI,
    contract=PluginContract(
        "local planner", LocalPlanner, ControllerSettings, "move_base_lite.local_planners"
    ),
    guarded=GuardedLocalPlanner,
)


def check_local_planner(name: str) -> None:
    """Raises SettingsError if there is no local planner of a name that a person gives.

    (move_base itself is asked for planners of all the world, and drives with the nearest that there is.)
    """
    if LOCAL_PLANNERS.find(name) is None:
        raise SettingsError(
            f"there is no local planner {name!r}{hint_or_choices(name, LOCAL_PLANNERS.names)}"
        )
