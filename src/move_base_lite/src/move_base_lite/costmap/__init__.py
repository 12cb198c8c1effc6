"""Costmaps: how dear it is to be where (after costmap_2d)."""

from move_base_lite.costmap.costmap import CostmapSettings, LayeredCostmap
from move_base_lite.costmap.costs import FREE, INSCRIBED, LETHAL, UNKNOWN, occupancy_of
from move_base_lite.costmap.footprint import Footprint, footprint_from
from move_base_lite.costmap.polygon import Polygon
from move_base_lite.costmap.sighting import Sighting, sighting_of_points, sighting_of_scan
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
    "Polygon",
    "Sighting",
    "Window",
    "footprint_from",
    "occupancy_of",
    "sighting_of_points",
    "sighting_of_scan",
]
