"""The contract of costmap layers, and a user-defined layer."""

from dataclasses import dataclass

import numpy as np
import pytest

from move_base_lite import costmap
from move_base_lite.check import CHECK_SUITES
from move_base_lite.costmap import (
    LAYERS,
    LETHAL,
    CostmapSettings,
    Layer,
    LayeredCostmap,
    LayerSettings,
    named_layers,
    observation_from_points,
)
from move_base_lite.costmap.layers.inflation import InflationSettings
from planar import Pose2
from planar.config.parameters import parameter
from planar.extensions import Plugin, Registry


@pytest.mark.parametrize("check", CHECK_SUITES["costmap_layer"].checks, ids=lambda check: check.__name__)
@pytest.mark.parametrize("member", LAYERS.members, ids=lambda member: member.short_name)
def test_a_layer_keeps_its_contract(member, check):
    check(member)


@dataclass(frozen=True)
class LineSettings(LayerSettings):
    col: int = parameter(3, "column that must not be crossed")


class LineLayer(Layer):
    """A user-defined layer."""

    def __init__(self, settings, site):
        self._col = settings.col

    def apply(self, costs, window, bounds):
        costs[bounds.row_min : bounds.row_max, self._col] = LETHAL


def test_a_user_defined_layer_is_inflated(monkeypatch):
    line = Plugin("mine::LineLayer", LineSettings, LineLayer)
    layers = Registry(LAYERS.point, *LAYERS.members, line)
    monkeypatch.setattr("move_base_lite.costmap.costmap.LAYERS", layers)
    layers_of_costmap = named_layers(line=LineSettings(col=4), inflation=InflationSettings())
    costmap = LayeredCostmap(CostmapSettings(width=1.0, height=1.0, layers=layers_of_costmap))
    assert (costmap.costs[:, 4] == LETHAL).all()
    assert (costmap.costs[:, [3, 5]] > 0).all()


def layer_written_before_the_rename(*bases):
    """A class of layers that names the method for observations ``note``, as contracts did before."""

    def note(self, observation, base_in_frame):
        self.topics.append(observation.topic)

    inherited = ("update", "apply", "clear_outside", "clear_inside", "take_over")
    methods = {} if bases else {name: getattr(Layer, name) for name in inherited}
    constructor = {"__init__": lambda self, settings, context: setattr(self, "topics", [])}
    return type("OldLayer", bases, {"note": note, **constructor, **methods})


@pytest.mark.parametrize("bases", [(Layer,), ()])
def test_a_layer_that_names_its_method_note_still_works(bases):
    with pytest.warns(DeprecationWarning, match="OldLayer.note is deprecated; name it add_observation"):
        kind = layer_written_before_the_rename(*bases)
        assert LAYERS.point.violations(kind) == []
    layer = kind(None, None)
    layer.add_observation(observation_from_points("cloud", 0.0, Pose2(), np.empty((0, 3))), Pose2())
    assert layer.topics == ["cloud"]
    Layer.note(None, Pose2())


@pytest.mark.parametrize(
    "old, new", [("Sighting", "Observation"), ("Site", "LayerContext"), ("Window", "CostmapWindow")]
)
def test_old_names_of_the_contract_can_still_be_imported(old, new):
    with pytest.warns(DeprecationWarning, match=f"costmap.{old} is deprecated"):
        assert getattr(costmap, old) is getattr(costmap, new)
