"""Layered costmaps (costmap_2d).

``layer.py`` is the contract of layers, ``layers/`` holds the layers, ``registry.py`` lists them.
"""

from move_base_lite.costmap.costmap import LayeredCostmap
from move_base_lite.costmap.costs import FREE, INSCRIBED, LETHAL, UNKNOWN, occupancy_of
from move_base_lite.costmap.footprint import Footprint, footprint_from
from move_base_lite.costmap.layer import CostmapPlacement, Layer, LayerContext, LayerSettings
from move_base_lite.costmap.observation import (
    Observation,
    observation_from_points,
    observation_from_projected_scan,
    observation_from_scan,
)
from move_base_lite.costmap.polygon import Polygon
from move_base_lite.costmap.registry import LAYERS
from move_base_lite.costmap.settings import CostmapSettings, NamedLayer, named_layers
from move_base_lite.costmap.static_maps import Maps, StaticMap, StaticMaps, StaticMapSource
from move_base_lite.costmap.window import CellBounds, CostmapWindow
from planar.deprecation import deprecated_names

__all__ = [
    "FREE",
    "INSCRIBED",
    "LAYERS",
    "LETHAL",
    "UNKNOWN",
    "CellBounds",
    "CostmapPlacement",
    "CostmapSettings",
    "CostmapWindow",
    "Footprint",
    "Layer",
    "LayerContext",
    "LayerSettings",
    "LayeredCostmap",
    "StaticMapSource",
    "Maps",
    "NamedLayer",
    "Observation",
    "Polygon",
    "StaticMap",
    "StaticMaps",
    "footprint_from",
    "named_layers",
    "observation_from_points",
    "observation_from_projected_scan",
    "observation_from_scan",
    "occupancy_of",
]

__getattr__ = deprecated_names(
    __name__,
    {
        "Bounds": "CellBounds",
        "Placement": "CostmapPlacement",
        "Sighting": "Observation",
        "Site": "LayerContext",
        "Window": "CostmapWindow",
        "sighting_of_points": "observation_from_points",
        "sighting_of_scan": "observation_from_scan",
    },
)
