"""Contract checks of plugins: ``python3 -m move_base_lite.check NAME``.

Each kind of plugin has a module of checks (planar.plugin_check); a check takes the Plugin.
"""

from functools import partial
from typing import Any

from move_base_lite.check import global_planners, layers, local_planners, recoveries
from move_base_lite.control import LOCAL_PLANNERS
from move_base_lite.costmap import LAYERS
from move_base_lite.planning import GLOBAL_PLANNERS
from move_base_lite.plugin import Registry
from move_base_lite.recovery import RECOVERIES
from planar.plugin_check import Check, CheckSuite


def _suite(registry: Registry[Any], *checks: Check) -> CheckSuite:
    return CheckSuite(partial(registry.find, is_package_needed=False), checks)


# The checks by kind of plugin.
CHECK_SUITES = {
    "local_planner": _suite(LOCAL_PLANNERS, *local_planners.CHECKS),
    "global_planner": _suite(GLOBAL_PLANNERS, *global_planners.CHECKS),
    "recovery_behavior": _suite(RECOVERIES, *recoveries.CHECKS),
    "costmap_layer": _suite(LAYERS, *layers.CHECKS),
}
