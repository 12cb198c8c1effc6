"""Registry of costmap layers; to add a layer, add it to LAYERS."""

from typing import Any, Callable, List

import numpy as np

from move_base_lite.costmap.layer import CostmapPlacement, Layer, LayerSettings, accept_note
from move_base_lite.costmap.layers.inflation import INFLATION
from move_base_lite.costmap.layers.obstacles import OBSTACLES, VOXEL
from move_base_lite.costmap.layers.static import STATIC
from move_base_lite.costmap.observation import Observation
from move_base_lite.costmap.window import CellBounds, CostmapWindow
from move_base_lite.errors import PluginFailed
from move_base_lite.plugin import Registry
from move_base_lite.plugin_guard import PluginGuard
from planar import Pose2
from planar.plugins import PluginContract


class GuardedLayer(Layer):
    """Wraps a user-defined layer; an error in it becomes PluginFailed with its name."""

    def __init__(self, name: str, make: Callable[[], Layer]):
        """Construct the wrapped layer.

        Args:
            name: Name of the plugin, for messages.
            make: Constructs the layer.

        Raises:
            PluginFailed: Its constructor raised.
        """
        self._guard = PluginGuard(name, make, PluginFailed)
        with self._guard.watch() as layer:
            self.reach_cells, self._kind = layer.reach_cells, layer.kind

    @property
    def kind(self) -> type:
        return self._kind

    def add_observation(self, observation: Observation, base_in_frame: Pose2) -> None:
        with self._guard.watch() as layer:
            layer.add_observation(observation, base_in_frame)

    def update(self, placement: CostmapPlacement) -> CellBounds:
        with self._guard.watch() as layer:
            return layer.update(placement)

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds: CellBounds) -> None:
        with self._guard.watch() as layer:
            layer.apply(costs, window, bounds)

    def clear_outside(self, bounds: CellBounds, window: CostmapWindow) -> CellBounds:
        with self._guard.watch() as layer:
            return layer.clear_outside(bounds, window)

    def clear_inside(self, bounds: CellBounds) -> CellBounds:
        with self._guard.watch() as layer:
            return layer.clear_inside(bounds)

    def take_over(self, before: Layer) -> None:
        if isinstance(before, GuardedLayer):
            with self._guard.watch() as layer, before._guard.watch() as replaced:
                layer.take_over(replaced)


class LayerContract(PluginContract):
    """Contract of layers; it accepts classes from before ``note`` was renamed to ``add_observation``."""

    def violations(self, found: Any) -> List[str]:
        if isinstance(found, type) and not issubclass(found, Layer):
            accept_note(found)
        return super().violations(found)


LAYERS: Registry[Layer] = Registry(
    STATIC,
    OBSTACLES,
    VOXEL,
    INFLATION,
    contract=LayerContract("costmap layer", Layer, LayerSettings, "move_base_lite.costmap_layers"),
    guarded=GuardedLayer,
)
