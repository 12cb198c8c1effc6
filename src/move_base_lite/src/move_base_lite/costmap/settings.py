"""Parameters of a costmap."""

import math
from dataclasses import dataclass, field
from typing import Tuple

from move_base_lite.costmap.layer import LayerSettings
from move_base_lite.costmap.layers.inflation import InflationSettings
from move_base_lite.costmap.layers.obstacles import ObstacleSettings
from move_base_lite.costmap.layers.static import StaticSettings
from planar.config.parameters import POSITIVE, at_least, check_parameters, parameter
from planar.config.settings import check


@dataclass(frozen=True)
class CostmapSettings:
    """Parameters of one costmap, with costmap_2d's names and defaults.

    The fields without an entry below are parameters; their meaning, unit and bounds are in
    ``parameter(...)``.

    Attributes:
        static: Settings of the static layer.
        obstacles: Settings of the obstacle layer.
        plugin_layers: Settings of further layers, applied below inflation.
        inflation: Settings of the inflation layer.
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
    static: StaticSettings = field(default_factory=lambda: StaticSettings(enabled=False))
    obstacles: ObstacleSettings = field(default_factory=ObstacleSettings)
    plugin_layers: Tuple[LayerSettings, ...] = ()
    inflation: InflationSettings = field(default_factory=InflationSettings)

    def __post_init__(self):
        check_parameters(self)
        check(len(self.footprint) not in (1, 2), "footprint", "at least 3 points", self.footprint)
