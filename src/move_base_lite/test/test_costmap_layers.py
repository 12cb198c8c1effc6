"""The contract of layers: what any of them, whoever wrote it, has to do; and one of one's own."""

from dataclasses import dataclass

import pytest

from move_base_lite.check import KITS
from move_base_lite.costmap import LAYERS, LETHAL, CostmapSettings, Layer, LayeredCostmap, LayerSettings
from move_base_lite.costmap.guarded import GuardedLayer
from move_base_lite.plugin import Plugin, Registry
from planar.config.parameters import parameter


@pytest.mark.parametrize("check", KITS["costmap_layer"].checks, ids=lambda check: check.__name__)
@pytest.mark.parametrize("member", LAYERS.members, ids=lambda member: member.short_name)
def test_a_layer_keeps_its_contract(member, check):
    check(member)


@dataclass(frozen=True)
class LineSettings(LayerSettings):
    col: int = parameter(3, "that must not be crossed")


class LineLayer(Layer):
    """A layer of somebody's own."""

    def __init__(self, settings, site):
        self._col = settings.col

    def apply(self, costs, window, bounds):
        costs[bounds.row_min : bounds.row_max, self._col] = LETHAL


def test_a_layer_of_ones_own_lies_below_inflation(monkeypatch):
    line = Plugin("mine::LineLayer", LineSettings, LineLayer)
    layers = Registry(*LAYERS.members, line, contract=LAYERS.contract, guarded=GuardedLayer)
    monkeypatch.setattr("move_base_lite.costmap.costmap.LAYERS", layers)
    costmap = LayeredCostmap(CostmapSettings(width=1.0, height=1.0, own_layers=(LineSettings(col=4),)))
    assert (costmap.costs[:, 4] == LETHAL).all()
    assert (costmap.costs[:, [3, 5]] > 0).all()
