"""Settings of costmaps with the usual layers, for tests."""

from dataclasses import replace

from move_base_lite.costmap import CostmapSettings, NamedLayer, named_layers
from move_base_lite.costmap.layers.inflation import InflationSettings
from move_base_lite.costmap.layers.obstacles import ObstacleSettings


def costmap_with(static=None, obstacles=ObstacleSettings(), inflation=InflationSettings(), **values):
    """Settings with the layers static (if given), obstacles and inflation, in this order."""
    layers = named_layers(obstacles=obstacles, inflation=inflation)
    if static is not None:
        layers = (NamedLayer("static", static), *layers)
    return CostmapSettings(layers=layers, **values)


def with_layer(settings, name, **changes):
    """The settings with other values of a layer."""
    layers = [
        replace(each, settings=replace(each.settings, **changes)) if each.name == name else each
        for each in settings.layers
    ]
    return replace(settings, layers=tuple(layers))
