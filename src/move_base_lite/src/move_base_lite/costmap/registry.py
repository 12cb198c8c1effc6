"""The layers that there are. To add one is to add it here."""

from move_base_lite.costmap.guarded import GuardedLayer
from move_base_lite.costmap.layer import Layer, LayerSettings
from move_base_lite.costmap.layers.inflation import INFLATION
from move_base_lite.costmap.layers.obstacles import OBSTACLES, VOXEL
from move_base_lite.costmap.layers.static import STATIC
from move_base_lite.plugin import Registry
from planar.plugins import Contract

LAYERS: Registry[Layer] = Registry(
    STATIC,
    OBSTACLES,
    VOXEL,
    INFLATION,
    contract=Contract("costmap layer", Layer, LayerSettings, "move_base_lite.costmap_layers"),
    guarded=GuardedLayer,
)
