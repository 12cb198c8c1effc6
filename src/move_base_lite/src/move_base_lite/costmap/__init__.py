"""Costmaps: how dear it is to be where (after costmap_2d).

``layer.py`` is the contract of layers, ``registry.py`` the list of those that hold it, ``layers/`` has them.
"""

from move_base_lite.costmap.costmap import LayeredCostmap
from move_base_lite.costmap.costs import FREE, INSCRIBED, LETHAL, UNKNOWN, occupancy_of
from move_base_lite.costmap.footprint import Footprint, footprint_from
from move_base_lite.costmap.layer import Layer, LayerSettings, Placement, Site
from move_base_lite.costmap.polygon import Polygon
from move_base_lite.costmap.registry import LAYERS
from move_base_lite.costmap.settings import CostmapSettings
from move_base_lite.costmap.sighting import Sighting, sighting_of_points, sighting_of_scan
from move_base_lite.costmap.window import Bounds, Window

__all__ = [
    "FREE",
    "INSCRIBED",
    "LAYERS",
    "LETHAL",
    "UNKNOWN",
    "Bounds",
    "CostmapSettings",
    "Footprint",
    "Layer",
    "LayerSettings",
    "LayeredCostmap",
    "Placement",
    "Polygon",
    "Sighting",
    "Site",
    "Window",
    "footprint_from",
    "occupancy_of",
    "sighting_of_points",
    "sighting_of_scan",
]
