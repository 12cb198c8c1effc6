"""The mechanism of extension points: views, guard, registry, checks of classes."""

import copy
import sys
import types
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np
import pytest

from planar import OccupancyGrid, PlanarError, Pose2
from planar.config.parameters import parameter
from planar.extensions import (
    ExtensionPoint,
    InvalidAnswer,
    Plugin,
    PluginError,
    Registry,
    SelectedPlugins,
    class_of,
    registries_of,
)
from planar.extensions.check import expect, expect_unchanged, run_checks, same_results, suite
from planar.extensions.views import read_only


class PainterError(PlanarError):
    """A painter failed."""


class OutOfPaint(PlanarError):  # noqa: N818
    """A painter may raise it."""


@dataclass(frozen=True)
class PainterSettings:
    shade: int = parameter(1, "what to paint")


class Painter(Protocol):
    strokes: int

    def __init__(self, settings: Any): ...

    def paint(self, canvas: np.ndarray, wall: OccupancyGrid) -> int:
        """Paint on the canvas, as on the wall; return how much."""
        ...


def _checked(painted: Any, canvas: np.ndarray, wall: OccupancyGrid) -> int:
    if not 0 <= painted <= canvas.size:
        raise InvalidAnswer(f"painted {painted} of {canvas.size}")
    return int(painted)


CONTRACT: ExtensionPoint[Painter] = ExtensionPoint(
    "painter",
    Painter,
    "test_package.painters",
    PainterError,
    passes=(OutOfPaint,),
    answers={"paint": _checked},
    writable=frozenset({"canvas"}),
    settings=PainterSettings,
    parameter="painter",
)


class Careful:
    strokes = 2

    def __init__(self, settings):
        self.shade = settings.shade

    def paint(self, canvas, wall):
        canvas[:] = self.shade
        return float(canvas.size)


class Careless(Careful):
    def paint(self, canvas, wall):
        wall.cells[:] = 0
        return 0


class Boasting(Careful):
    def paint(self, canvas, wall):
        return 10**6


class Empty(Careful):
    def paint(self, canvas, wall):
        raise OutOfPaint("no paint")


class Broken(Careful):
    def __init__(self, settings):
        raise OSError("no brush")


class Derived(Careful):
    @dataclass(frozen=True)
    class Settings(PainterSettings):
        thickness: int = 3


class DerivedToo(Derived):
    def paint(self, canvas, wall):
        return 7


PAINTERS = Registry(CONTRACT, Plugin("test_package/Careful", PainterSettings, Careful))


@pytest.fixture(autouse=True)
def module(monkeypatch):
    mine = types.ModuleType("mine.painters")
    mine.__file__ = __file__
    for kind in (Careful, Careless, Boasting, Empty, Broken, Derived, DerivedToo):
        setattr(mine, kind.__name__, kind)
    monkeypatch.setitem(sys.modules, "mine.painters", mine)


def grid():
    return OccupancyGrid(np.ones((2, 3), np.int8), 0.1)


def painted_by(name):
    return CONTRACT.make(f"mine.painters/{name}", PainterSettings(4)).paint(np.zeros(6), grid())


def test_an_array_is_given_as_a_view_that_cannot_be_written_to():
    array = np.zeros(3)
    view = read_only(array)
    array[0] = 1.0
    assert view[0] == 1.0 and np.shares_memory(view, array)
    with pytest.raises(ValueError, match="read-only"):
        view[0] = 2.0


@dataclass(frozen=True, eq=False)
class Outer:
    grid: OccupancyGrid
    points: np.ndarray
    pose: Pose2 = Pose2()
    late: Any = None
    names: list = field(default_factory=list)


def test_the_arrays_of_an_object_and_of_its_attributes_are_views_and_all_else_is_the_same():
    outer = Outer(grid(), np.zeros((4, 2)), names=["wall"])
    given = read_only(outer)
    assert type(given) is Outer and given.pose is outer.pose and given.names is outer.names
    assert not (given.points.flags.writeable or given.grid.cells.flags.writeable)
    assert outer.points.flags.writeable and outer.grid.cells.flags.writeable
    assert np.shares_memory(given.grid.cells, outer.grid.cells)


def test_an_attribute_that_holds_an_array_only_later_is_a_view_too():
    assert read_only(Outer(grid(), np.zeros(1))).late is None
    assert not read_only(Outer(grid(), np.zeros(1), late=np.zeros(2))).late.flags.writeable


@pytest.mark.parametrize("value", [3, "text", None, Pose2(1.0, 2.0), [1], len])
def test_what_holds_no_array_is_given_as_it_is(value):
    assert read_only(value) is value


def test_only_the_arguments_that_a_contract_names_can_be_written_to():
    canvas = np.zeros(6)
    plugin = CONTRACT.make("mine.painters/Careful", PainterSettings(4))
    assert plugin.paint(canvas, wall=grid()) == 6
    assert (canvas == 4).all()
    assert class_of(plugin) is Careful


def test_attributes_are_those_of_the_plugin_and_those_of_the_protocol_may_be_missing():
    plugin = CONTRACT.make("mine.painters/Careful", PainterSettings(4))
    lazy = replace(CONTRACT, is_lazy=True).make("mine.painters/Broken", PainterSettings())
    assert (plugin.strokes, plugin.shade, lazy.strokes) == (2, 4, None)
    assert not (hasattr(plugin, "brushes") or hasattr(lazy, "shade"))
    assert copy.copy(plugin).paint(np.zeros(6), grid()) == 6


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("Careless", "mine.painters/Careless raised ValueError: assignment destination is read-only"),
        ("Boasting", "mine.painters/Boasting painted 1000000 of 6"),
        ("Broken", "mine.painters/Broken raised OSError: no brush"),
    ],
)
def test_a_failure_names_the_plugin(name, text):
    with pytest.raises(PainterError) as raised:
        painted_by(name)
    assert str(raised.value) == text


def test_errors_of_the_contract_pass_unchanged():
    with pytest.raises(OutOfPaint, match="^no paint$"):
        painted_by("Empty")


def test_an_argument_that_is_returned_is_the_callers_own():
    class Same:
        def give(self, value):
            return value

    value = grid()
    assert ExtensionPoint("giver", Same, "givers").guarded("mine/Same", Same).give(value) is value


def test_a_name_without_a_class_is_refused():
    with pytest.raises(
        PluginError, match="painter must be like my_package.my_module/MyPainter, got 'Nobody'"
    ):
        CONTRACT.make("Nobody", PainterSettings())


def test_two_classes_that_share_their_settings_are_distinguished():
    first, second = (PAINTERS.find(f"mine.painters/{name}") for name in ("Derived", "DerivedToo"))
    canvas = np.zeros(9)
    assert PAINTERS.make(first.settings()).paint(canvas, grid()) == 9
    assert PAINTERS.make(second.settings(thickness=5)).paint(canvas, grid()) == 7


def test_the_plugins_of_a_package_are_selected_by_parameters():
    assert registries_of("test_package") == {"painter": PAINTERS}
    default = SelectedPlugins({})[PAINTERS]
    assert type(default) is Careful and default.shade == 1
    settings = PAINTERS.find("mine.painters/Careful").settings(shade=5)
    selected = SelectedPlugins({"painter": settings})
    canvas = np.zeros(2)
    selected[PAINTERS].paint(canvas, grid())
    assert (canvas == 5).all() and selected[PAINTERS] is selected[PAINTERS]


def paints_everything(painter):
    """It paints the whole canvas."""
    with expect_unchanged(wall=np.zeros(3)):
        painted = painter.paint(np.zeros(6), grid())
    expect(painted == 6, f"{painted} of 6")


SUITES = {
    "painter": suite(
        CONTRACT,
        lambda name: CONTRACT.make(name, PainterSettings()),
        paints_everything,
        same_results(lambda painter: painter.paint(np.zeros(6), grid())),
    )
}


@pytest.mark.parametrize(
    ("name", "code", "output"),
    [
        ("Careful", 0, "mine.painters/Careful: 2 of 2 checks passed"),
        ("DerivedToo", 1, "FAIL  It paints the whole canvas.\n      mine.painters/DerivedToo painted 7 of 6"),
    ],
)
def test_checks_are_run_by_the_name_of_a_plugin(name, code, output, capsys):
    assert run_checks("test_package", SUITES, [f"mine.painters/{name}"]) == code
    assert output in capsys.readouterr().out


def test_a_check_finds_arrays_that_were_changed():
    array = np.zeros(3)
    with pytest.raises(Exception, match="the call modified the grid cells"), expect_unchanged(
        grid_cells=array
    ):
        array[0] = np.nan
