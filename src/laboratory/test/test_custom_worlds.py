"""Custom world generators: found by name, configured by the scenario, and named in their errors."""

import sys
from dataclasses import dataclass, replace

import pytest

from laboratory.scenario import read_scenario
from laboratory.suites import FOLDER
from laboratory.worlds.solids import FLOOR, wall
from laboratory.worlds.source import Arena
from planar import SettingsError
from sim_bridge import WorldError
from sim_bridge.faults import Fault
from sim_bridge.world import World

SCENARIO = """\
world:
  custom.world/NAME: VALUES
task: {reach: {x: 3.0, y: 0.0, radius: 0.5}}
"""


@dataclass(frozen=True)
class Corridor:
    """Two walls, ``width`` m apart and at an x that is the seed."""

    width: float = 2.0
    walls: int = 2

    def arena(self, seed: int) -> Arena:
        sides = (0.5, -0.5, 1.5, -1.5)[: self.walls]
        walls = [wall(f"w{side}", float(seed), side * self.width, 4.0, 0.1) for side in sides]
        return Arena(World("corridor", (FLOOR, *walls)), None, f"corridor {seed}")


@dataclass(frozen=True)
class WithoutDefaults(Corridor):
    width: float
    walls: int


class NotFrozen:
    def arena(self, seed):
        return None


@dataclass(frozen=True)
class WithoutArena:
    def place(self, seed):
        return None


@dataclass(frozen=True)
class Raises:
    def arena(self, seed):
        raise ZeroDivisionError("division by zero")


@dataclass(frozen=True)
class ReturnsNone:
    def arena(self, seed):
        return None


@pytest.fixture
def read(monkeypatch, tmp_path):
    """Reads a scenario with one of these generators and values for its fields."""
    monkeypatch.setitem(sys.modules, "custom.world", sys.modules[__name__])

    def reading(kind, values="{}"):
        name = kind if isinstance(kind, str) else kind.__name__
        path = tmp_path / "scenario.yaml"
        path.write_text(SCENARIO.replace("NAME", name).replace("VALUES", values))
        return read_scenario(path)

    return reading


def test_a_scenario_names_a_generator_and_sets_its_fields(read):
    scenario = read(Corridor, "{width: 3.0}")
    arena = scenario.arena(7)
    assert arena.title == "corridor 7"
    assert [body.pose_in_world[0, 3] for body in arena.world.bodies[1:]] == [7.0, 7.0]
    assert abs(arena.world.bodies[1].pose_in_world[1, 3]) == 1.5
    assert scenario.world.arena_number(7) == 7


def test_its_fields_and_its_source_are_part_of_the_digest(read):
    assert read(Corridor).digest() == read(Corridor, "{walls: 2}").digest()
    assert read(Corridor).digest() != read(Corridor, "{width: 3.0}").digest()
    assert [path.name for path in read(Corridor).world.files()] == ["test_custom_worlds.py"]


@pytest.mark.parametrize(
    ("kind", "values", "complaint"),
    [
        (Corridor, "{width: wide}", ":2: world.custom.world/Corridor.width must be a number, got 'wide'"),
        (
            Corridor,
            "{wdith: 3.0}",
            ':2: unknown key "world.custom.world/Corridor.wdith" (did you mean "width"?)',
        ),
        (NotFrozen, "{}", "is no world generator: it is not a frozen dataclass"),
        (WithoutArena, "{}", "is no world generator: it has no arena(seed)"),
        (
            "Nowhere",
            "{}",
            ":2: world.custom.world/Nowhere cannot be used: custom.world/Nowhere: no Nowhere",
        ),
    ],
)
def test_an_unusable_generator_is_reported_with_file_and_line(read, kind, values, complaint):
    with pytest.raises(SettingsError) as refused:
        read(kind, values)
    assert "scenario.yaml:2" in str(refused.value) and complaint in str(refused.value)


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (Raises, "raised ZeroDivisionError: division by zero"),
        (ReturnsNone, "returned a NoneType, expected an Arena"),
    ],
)
def test_its_errors_name_it(read, kind, message):
    with pytest.raises(WorldError, match=f"^custom.world/{kind.__name__} {message}"):
        read(kind).arena(0)


def test_changed_code_of_a_planner_or_fault_changes_the_digest(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "changing").mkdir()
    source = tmp_path / "changing/code.py"
    scenario = read_scenario(FOLDER / "home_errand.yaml")
    digests = {}
    for text in ("one = 1\n", "one = 2\n"):
        source.write_text(text)
        played = (
            scenario.with_planner("changing.code/Mine"),
            replace(scenario, faults=(Fault("changing.code/Mine"),)),
            scenario,
        )
        digests[text] = [each.digest() for each in played]
    before, after = digests.values()
    assert [was == now for was, now in zip(before, after)] == [False, False, True]


@pytest.mark.parametrize("planner", ["no_such.module/Mine", "../Mine", "no_such_either"])
def test_a_missing_planner_does_not_break_the_digest(planner):
    assert read_scenario(FOLDER / "home_errand.yaml").with_planner(planner).digest()
