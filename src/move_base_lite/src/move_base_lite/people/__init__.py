"""Deprecated name of move_base_lite.dynamic_obstacles."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(
    __name__,
    {
        "NO_MOVERS": "move_base_lite.dynamic_obstacles:NO_DYNAMIC_OBSTACLES",
        "Lookout": "move_base_lite.dynamic_obstacles:TrackerSettings",
        "Movers": "move_base_lite.dynamic_obstacles:DynamicObstacleTracker",
    },
)
