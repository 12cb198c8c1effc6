"""Documented names of older versions still work, with a warning."""

import importlib

import numpy as np
import pytest

from amcl_lite import Localizer, LocalizerSettings
from amcl_lite.motion.custom_model import MotionModel
from amcl_lite.sensor.custom_model import SensorModel
from planar import grid_from_picture
from planar.config.parameters import Interval


@pytest.mark.parametrize(
    ("module", "name", "replacement"),
    [
        ("amcl_lite.motion.own_model", "MotionModel", MotionModel),
        ("amcl_lite.sensor.own_model", "SensorModel", SensorModel),
        ("planar.config.parameters", "Bounds", Interval),
    ],
)
def test_an_old_name_is_importable(module, name, replacement):
    with pytest.warns(DeprecationWarning, match=f"{module}.{name} is deprecated"):
        assert getattr(importlib.import_module(module), name) is replacement


def test_an_old_method_calls_its_replacement():
    grid = grid_from_picture("####\n#..#\n####")
    localizer = Localizer(grid, LocalizerSettings(), np.random.default_rng(0))
    with pytest.warns(DeprecationWarning, match="use start_global_localization"):
        localizer.scatter()
    assert localizer.is_lost
