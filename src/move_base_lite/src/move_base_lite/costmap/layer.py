"""Contract of costmap layers: what each layer adds to the costs (costmap_2d: Layer).

Life cycle:

1. A layer is constructed with its settings and a LayerContext whenever the costmap is: at start-up, for a new
   map and when settings change. ``Layer.take_over`` may then copy the state of the layer of the same name.
2. ``Layer.add_observation`` receives sensor data as it arrives.
3. At each update, ``Layer.update`` follows the window and returns the cells that may have changed.
4. ``Layer.apply`` writes the layer's costs over those of the layers below, in the cells that changed in
   any layer.

Layers are applied in the order of the parameter ``plugins``; the zones come just below the first inflation
layer. A layer that is not enabled receives observations, but is neither updated nor applied.

To add a layer to this package, write a module with settings (a subclass of LayerSettings), a class and its
Plugin, and add it to ``costmap/registry.py``. ``test/test_costmap_layers.py`` checks the contract.
"""

import warnings
from dataclasses import dataclass
from typing import Any, Iterable, Optional

import numpy as np

from move_base_lite.costmap.footprint import Footprint
from move_base_lite.costmap.observation import Observation
from move_base_lite.costmap.static_maps import StaticMap, StaticMaps, StaticMapSource
from move_base_lite.costmap.window import NO_CELLS, CellBounds, CostmapWindow
from move_base_lite.errors import NavigationError, PluginFailed
from planar import OccupancyGrid, Pose2
from planar.config.parameters import parameter
from planar.deprecation import deprecated_names
from planar.extensions import MAX_CALL_SECONDS, ExtensionPoint


@dataclass(frozen=True)
class LayerSettings:
    """Parameters of any layer; base class of the settings of a layer."""

    enabled: bool = parameter(True, "whether the layer adds costs", dynamic=True)


@dataclass(frozen=True, eq=False)
class LayerContext:
    """Arguments for the construction of a layer.

    Attributes:
        window: Cells of the costmap; it moves if ``is_rolling``.
        is_rolling: Whether the window follows the robot.
        footprint: Outline of the robot.
        grid: Map of the first static layer, if there is one.
        maps: Maps of all static layers.
        global_frame: Frame of the costmap.
    """

    window: CostmapWindow
    is_rolling: bool
    footprint: Footprint
    grid: Optional[OccupancyGrid] = None
    maps: StaticMaps = StaticMaps()
    global_frame: str = ""

    def find_map(self, source: StaticMapSource) -> Optional[StaticMap]:
        """Return the map of a source; without one that of ``grid``, if there is one."""
        return self.maps.find(source) or StaticMaps.of(self.grid).find(source)


@dataclass(frozen=True)
class CostmapPlacement:
    """Position of the costmap and of the robot at an update.

    Attributes:
        window: Cells of the costmap now.
        rows: Rows by which the window has moved since the last update.
        cols: Columns by which the window has moved since the last update.
        base_in_frame: Robot in the costmap's frame.
        map_in_frame: Map in the costmap's frame.
    """

    window: CostmapWindow
    rows: int
    cols: int
    base_in_frame: Pose2
    map_in_frame: Pose2


class Layer:
    """Base class of layers; constructed as ``Layer(settings, context)``, a LayerSettings and a LayerContext.

    The defaults are those of a layer without sensor data; a subclass overrides what differs. Costs are uint8
    (rows, cols) with the values of ``costs.py``; bounds are blocks of cells.

    Attributes:
        reach_cells: Distance in cells within which one changed cell changes others through this layer.
    """

    reach_cells: int = 0
    # The name of add_observation before 1.0. Subclasses may still call it as super().note(...).
    note: Any = staticmethod(lambda observation, base_in_frame: None)

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        accept_note(cls)

    @property
    def kind(self) -> type:
        """Type of the layers whose state this layer can take over."""
        return type(self)

    def add_observation(self, observation: Observation, base_in_frame: Pose2) -> None:
        """Store sensor data for the next update.

        Args:
            observation: Beams of one sensor.
            base_in_frame: Robot in the costmap's frame when they were measured.
        """

    def update(self, placement: CostmapPlacement) -> CellBounds:
        """Follow the window and integrate the stored observations.

        Args:
            placement: Position of the costmap and of the robot now.

        Returns:
            Block of cells whose costs may have changed.
        """
        return NO_CELLS

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds: CellBounds) -> None:
        """Write this layer's costs over those of the layers below.

        Args:
            costs: Costs of the layers below, uint8 (rows, cols); changed in place.
            window: Position of the cells.
            bounds: Block of cells to change; all others stay.
        """
        raise NotImplementedError

    def clear_outside(self, bounds: CellBounds, window: CostmapWindow) -> CellBounds:
        """Clear sensor data outside of a block of cells.

        Args:
            bounds: Block of cells that keep their data.
            window: Position of the cells.

        Returns:
            Block of cells whose costs may have changed.
        """
        return NO_CELLS

    def clear_inside(self, bounds: CellBounds) -> CellBounds:
        """Clear sensor data inside a block of cells.

        Args:
            bounds: Block of cells to clear.

        Returns:
            Block of cells whose costs may have changed.
        """
        return NO_CELLS

    def take_over(self, before: "Layer") -> None:
        """Copy the state of the layer that this one replaces.

        Args:
            before: Replaced layer of the same ``kind``; its window has the same size.
        """


def accept_note(layer: type) -> None:
    """Use the deprecated method ``note`` of a class as ``add_observation`` if it has only that.

    Emits a DeprecationWarning in this case.

    Args:
        layer: Class of a user-defined layer; modified.
    """
    own = vars(layer)
    if "note" in own and "add_observation" not in own:
        warnings.warn(
            f"{layer.__module__}.{layer.__name__}.note is deprecated; name it add_observation",
            DeprecationWarning,
            stacklevel=3,
        )
        layer.add_observation = own["note"]  # type: ignore[attr-defined]


def _requirements(found: type) -> Iterable[str]:
    if not issubclass(found, Layer):
        accept_note(found)
    return ()


CONTRACT: ExtensionPoint[Layer] = ExtensionPoint(
    "costmap layer",
    Layer,
    "move_base_lite.costmap_layers",
    PluginFailed,
    passes=(NavigationError,),
    writable=frozenset({"costs"}),
    max_seconds=MAX_CALL_SECONDS,
    settings=LayerSettings,
    requirements=_requirements,
)
__getattr__ = deprecated_names(__name__, {"Placement": "CostmapPlacement", "Site": "LayerContext"})
