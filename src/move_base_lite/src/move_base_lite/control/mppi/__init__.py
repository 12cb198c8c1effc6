"""Model predictive path integral control, the presets' local planner."""

from move_base_lite.control.local_planner import LocalPlanner
from move_base_lite.control.mppi.planner import PathIntegral
from move_base_lite.control.mppi.settings import MppiSettings
from move_base_lite.plugin import Plugin

MPPI: Plugin[LocalPlanner] = Plugin("move_base_lite/MppiPlannerROS", MppiSettings, PathIntegral)

__all__ = ["MPPI", "MppiSettings", "PathIntegral"]
