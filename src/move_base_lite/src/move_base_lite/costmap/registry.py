"""Registry of the costmap layers."""

from move_base_lite.costmap.layer import CONTRACT, Layer
from move_base_lite.costmap.layers.inflation import INFLATION
from move_base_lite.costmap.layers.obstacles import OBSTACLES
from move_base_lite.costmap.layers.static import STATIC
from move_base_lite.costmap.layers.voxels import VOXEL
from planar.extensions import Registry

LAYERS: Registry[Layer] = Registry(CONTRACT, STATIC, OBSTACLES, VOXEL, INFLATION)
