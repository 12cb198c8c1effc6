"""Registry of the local planners."""

from move_base_lite.control.dwa import DWA, TRAJECTORY
from move_base_lite.control.local_planner import CONTRACT, LocalPlanner
from move_base_lite.control.mppi import MPPI
from planar import SettingsError
from planar.config.hints import hint_or_choices
from planar.extensions import Registry

LOCAL_PLANNERS: Registry[LocalPlanner] = Registry(
    CONTRACT,
    TRAJECTORY,
    DWA,
    MPPI,
)


def check_local_planner(name: str) -> None:
    """Check a local planner's name given by a user.

    The parameter ``base_local_planner`` may also have a name of the official stack that is unknown here;
    move_base then uses the first of LOCAL_PLANNERS.

    Args:
        name: Name of the planner.

    Raises:
        SettingsError: There is no local planner of this name.
    """
    if LOCAL_PLANNERS.find(name) is None:
        raise SettingsError(
            f"there is no local planner {name!r}{hint_or_choices(name, LOCAL_PLANNERS.names)}"
        )
