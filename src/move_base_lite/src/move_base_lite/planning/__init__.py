"""Global planning: a way through a costmap."""

from move_base_lite.planning.planner import GlobalPlanner, PlannerSettings

__all__ = ["GlobalPlanner", "PlannerSettings"]
