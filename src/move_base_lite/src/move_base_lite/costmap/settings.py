"""Parameters of a costmap."""

import math
from dataclasses import dataclass
from typing import Tuple

from move_base_lite.costmap.layer import LayerSettings
from move_base_lite.costmap.layers.inflation import InflationSettings
from move_base_lite.costmap.layers.obstacles import ObstacleSettings, SourceSettings
from move_base_lite.costmap.layers.static import StaticSettings
from planar.config.parameters import POSITIVE, at_least, check_parameters, parameter
from planar.config.settings import check


@dataclass(frozen=True)
class NamedLayer:
    """An entry of a costmap's layers.

    Attributes:
        name: Name of the layer, the namespace of its parameters.
        settings: Settings of the layer; their type selects its class.
    """

    name: str
    settings: LayerSettings


def named_layers(**settings: LayerSettings) -> Tuple[NamedLayer, ...]:
    """Return layers in the order of the arguments, named as these."""
    return tuple(NamedLayer(name, each) for name, each in settings.items())


@dataclass(frozen=True)
class CostmapSettings:
    """Parameters of one costmap, with costmap_2d's names and defaults.

    The fields without an entry below are parameters; their meaning, unit and bounds are in
    ``parameter(...)``.

    Attributes:
        layers: The layers, in the order in which they are applied.
    """

    global_frame: str = parameter("map", "frame in which the costmap lies")
    robot_base_frame: str = parameter("base_link", "the robot's frame")
    transform_tolerance: float = parameter(
        0.3, "age up to which a transform is used", "s", dynamic=(0.0, 10.0)
    )
    update_frequency: float = parameter(5.0, "", "Hz", at_least(0.0), dynamic=100.0)
    publish_frequency: float = parameter(
        0.0, "of the costmap's topics; 0: only for new subscribers", "Hz", at_least(0.0), dynamic=100.0
    )
    rolling_window: bool = parameter(False, "whether the window follows the robot")
    width: float = parameter(10.0, "unless the map sets the size", "m", POSITIVE, dynamic=True)
    height: float = parameter(10.0, "unless the map sets the size", "m", POSITIVE, dynamic=True)
    resolution: float = parameter(0.05, "of a cell, unless the map sets it", "m", POSITIVE, dynamic=50.0)
    origin_x: float = parameter(0.0, "of the lower left corner, unless the window follows", "m", dynamic=True)
    origin_y: float = parameter(0.0, "of the lower left corner, unless the window follows", "m", dynamic=True)
    footprint: Tuple[Tuple[float, float], ...] = parameter(
        (), "corners [x, y]; empty: a circle of robot_radius", "m", dynamic=True
    )
    robot_radius: float = parameter(0.46, "of a round footprint", "m", at_least(0.0), dynamic=10.0)
    footprint_padding: float = parameter(
        0.01, "added around the footprint", "m", at_least(0.0), dynamic=(-math.inf, math.inf)
    )
    track_unknown_space: bool = parameter(
        False, "whether cells without observations are unknown rather than free"
    )
    always_send_full_costmap: bool = parameter(False, "publish the complete costmap instead of updates")
    layers: Tuple[NamedLayer, ...] = named_layers(
        obstacle_layer=ObstacleSettings(), inflation_layer=InflationSettings()
    )

    def __post_init__(self):
        check_parameters(self)
        check(len(self.footprint) not in (1, 2), "footprint", "at least 3 points", self.footprint)

    @property
    def obstacle_layers(self) -> Tuple[ObstacleSettings, ...]:
        """Settings of the obstacle layers."""
        return tuple(each.settings for each in self.layers if isinstance(each.settings, ObstacleSettings))

    @property
    def sources(self) -> Tuple[SourceSettings, ...]:
        """Observation sources of all obstacle layers."""
        return tuple(source for layer in self.obstacle_layers for source in layer.sources)

    @property
    def static_layers(self) -> Tuple[StaticSettings, ...]:
        """Settings of the static layers."""
        return tuple(each.settings for each in self.layers if isinstance(each.settings, StaticSettings))
