"""Tracking of people and other dynamic obstacles in laser scans."""

from move_base_lite.dynamic_obstacles.tracker import (
    NO_DYNAMIC_OBSTACLES,
    DynamicObstacleTracker,
    TrackerSettings,
)

__all__ = ["NO_DYNAMIC_OBSTACLES", "DynamicObstacleTracker", "TrackerSettings"]
