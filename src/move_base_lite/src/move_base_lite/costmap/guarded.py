"""Stands before a costmap layer of other people: what it raises is its own fault."""

from typing import Callable

import numpy as np

from move_base_lite.costmap.layer import Layer, Placement
from move_base_lite.costmap.sighting import Sighting
from move_base_lite.costmap.window import Bounds, Window
from move_base_lite.errors import PluginFailed
from move_base_lite.guarding import Guard
from planar import Pose2


class GuardedLayer(Layer):
    """See Layer."""

    def __init__(self, name: str, make: Callable[[], Layer]):
        self._guard = Guard(name, make, PluginFailed)
        with self._guard.watch() as layer:
            self.reach_cells, self._kind = layer.reach_cells, layer.kind

    @property
    def kind(self) -> type:
        return self._kind

    def note(self, sighting: Sighting, base_in_frame: Pose2) -> None:
        with self._guard.watch() as layer:
            layer.note(sighting, base_in_frame)

    def update(self, placement: Placement) -> Bounds:
        with self._guard.watch() as layer:
            return layer.update(placement)

    def apply(self, costs: np.ndarray, window: Window, bounds: Bounds) -> None:
        with self._guard.watch() as layer:
            layer.apply(costs, window, bounds)

    def clear_outside(self, bounds: Bounds, window: Window) -> Bounds:
        with self._guard.watch() as layer:
            return layer.clear_outside(bounds, window)

    def clear_inside(self, bounds: Bounds) -> Bounds:
        with self._guard.watch() as layer:
            return layer.clear_inside(bounds)

    def take_over(self, before: Layer) -> None:
        if isinstance(before, GuardedLayer):
            with self._guard.watch() as layer, before._guard.watch() as known:
                layer.take_over(known)
