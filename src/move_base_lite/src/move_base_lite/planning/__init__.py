"""Global planning: a way through a costmap."""

from move_base_lite.planning.headings import headings_along
from move_base_lite.planning.planner import GlobalPlanner, PlannerSettings, Potential, path_cost

__all__ = ["GlobalPlanner", "PlannerSettings", "Potential", "headings_along", "path_cost"]
