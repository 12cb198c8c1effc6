"""Costmaps: how dear it is to be where (after costmap_2d)."""

from move_base_lite.costmap.costmap import CostmapSettings, LayeredCostmap
from move_base_lite.costmap.costs import FREE, INSCRIBED, LETHAL, UNKNOWN, occupancy_of
from move_base_lite.costmap.footprint import Footprint, footprint_from
from move_base_lite.costmap.window import Bounds, Window

__all__ = [
    "FREE",
    "INSCRIBED",
    "LETHAL",
    "UNKNOWN",
    "Bounds",
    "CostmapSettings",
    "Footprint",
    "LayeredCostmap",
    "Window",
    "footprint_from",
    "occupancy_of",
]
