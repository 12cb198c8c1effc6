"""The contract of a costmap's layers: what each adds to the costs.

Life cycle. A layer is made with its settings for a Site whenever the costmap is: at the start, for another
map and when settings change; then it may take over what the one before knew. It is told of what sensors see
as they speak (:meth:`~Layer.note`). At each update of the costmap it follows the window and says which cells
may have changed (:meth:`~Layer.update`); then each layer in turn puts its costs over those below, in the
cells that changed for any of them (:meth:`~Layer.apply`). From below: the map, obstacles, zones, own
layers, inflation.

To add one: a file with settings (a subclass of LayerSettings), a class and its Plugin, and a line in
``costmap/registry.py``. ``test/test_costmap_layers.py`` holds it to what is said here.
"""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from move_base_lite.costmap.footprint import Footprint
from move_base_lite.costmap.sighting import Sighting
from move_base_lite.costmap.window import NO_CELLS, Bounds, Window
from planar import OccupancyGrid, Pose2
from planar.config.parameters import parameter


@dataclass(frozen=True)
class LayerSettings:
    """What every layer can be told."""

    enabled: bool = parameter(True, "whether the layer counts", dynamic=True)


@dataclass(frozen=True, eq=False)
class Site:
    """What a layer is made for.

    ``window``: the costmap's cells; it moves if ``is_rolling``. ``grid``: the map, if there is one.
    """

    window: Window
    is_rolling: bool
    footprint: Footprint
    grid: Optional[OccupancyGrid] = None


@dataclass(frozen=True)
class Placement:
    """Where the costmap lies at an update, and the robot in its frame.

    The window has moved by ``rows`` and ``cols`` since the last one.
    """

    window: Window
    rows: int
    cols: int
    base_in_frame: Pose2
    map_in_frame: Pose2


class Layer:
    """Made by ``make(settings, site)``. An heir says what is otherwise than here, where nothing is known.

    All costs are uint8 (rows, cols) with the meaning of ``costs.py``; bounds are blocks of cells.
    """

    reach_cells: int = 0  # how far from a cell that changes others change through this layer

    @property
    def kind(self) -> type:
        """Whose knowledge it may take over: that of a layer of the same kind."""
        return type(self)

    def note(self, sighting: Sighting, base_in_frame: Pose2) -> None:
        """Keeps what a sensor saw from there for the next update."""

    def update(self, placement: Placement) -> Bounds:
        """Follows the window and takes in what was noted; returns the block that may have changed."""
        return NO_CELLS

    def apply(self, costs: np.ndarray, window: Window, bounds: Bounds) -> None:
        """Puts its costs over those below, in place and in the cells of ``bounds`` only."""
        raise NotImplementedError

    def clear_outside(self, bounds: Bounds, window: Window) -> Bounds:
        """Forgets what was seen but in a block; returns what may have changed."""
        return NO_CELLS

    def clear_inside(self, bounds: Bounds) -> Bounds:
        """Forgets what was seen in a block; returns what may have changed."""
        return NO_CELLS

    def take_over(self, before: "Layer") -> None:
        """Goes on with what the same layer knew under other settings, in a window of the same size."""
