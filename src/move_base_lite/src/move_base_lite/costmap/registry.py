"""The layers that there are. To add one is to add it here."""

from move_base_lite.costmap.layer import Layer
from move_base_lite.costmap.layers.inflation import INFLATION
from move_base_lite.costmap.layers.obstacles import OBSTACLES, VOXEL
from move_base_lite.costmap.layers.static import STATIC
from move_base_lite.plugin import Registry

LAYERS: Registry[Layer] = Registry(
    STATIC,
    OBSTACLES,
    VOXEL,
    INFLATION,
)
