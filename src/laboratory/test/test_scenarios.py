import sys
from dataclasses import replace
from pathlib import Path

import pytest

from laboratory.scenario import read_scenario
from laboratory.scenario.seeds import parse_seeds
from laboratory.suites import FOLDER, load_suites
from planar import Pose2, SettingsError

ROOT = FOLDER.parent
ALL_KEYS = """\
about: all keys
world: {file: ROOT/map/home.world, map: ROOT/map/home.yaml}
robot: {profile: turtlebot_lidar, start: {x: 0.5, y: 0.1, yaw: 0.2}}
simulation: {noise: high, range_noise: 0.02}
task: {errand: ROOT/map/zones.yaml}
happens:
  boxes: 3
  faults: [{kind: scan_noisy, start: 8.0, end: 12.0}]
planner: {name: dwa_local_planner/DWAPlannerROS, parameters: {DWAPlannerROS: {max_vel_x: 0.4}}}
limits: {seconds: 200}
seeds: 0-4,9
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "scenario.yaml"
    path.write_text(text.replace("ROOT", str(ROOT)))
    return path


def test_every_key_of_a_scenario_is_read(tmp_path):
    scenario = read_scenario(written(tmp_path, ALL_KEYS))
    assert scenario.name == "scenario" and scenario.about == "all keys"
    assert scenario.start == Pose2(0.5, 0.1, 0.2)
    assert (scenario.simulation.range_noise, scenario.simulation.encoder_scale) == (0.02, 0.06)
    assert scenario.boxes == 3 and scenario.faults[0].end == 12.0
    assert scenario.planner == "dwa_local_planner/DWAPlannerROS"
    assert scenario.parameters == {"DWAPlannerROS": {"max_vel_x": 0.4}}
    assert scenario.seconds == 200.0 and scenario.seeds == (0, 1, 2, 3, 4, 9)


@pytest.mark.parametrize(
    ("was", "becomes", "complaint"),
    [
        ("about: all keys", "abuot: x", ':1: unknown key "abuot" (did you mean "about"?)'),
        ("map: ROOT", "mop: ROOT", ':2: unknown key "world.mop"'),
        ("{file: ROOT/map/home.world", "{fiel: x", ":2: world needs one of file"),
        ("turtlebot_lidar", "turtlebto_lidar", ":3: robot.profile cannot be used: unknown robot"),
        ("y: 0.1", "y: left", ":3: robot.start.y must be a number"),
        ("noise: high", "noise: worse", ":4: simulation.noise cannot be used: noise must be one of"),
        ("range_noise: 0.02", "range_noise: -1", "range_noise must be not negative, got -1"),
        ("range_noise", "rainge_noise", ':4: unknown key "simulation.rainge_noise"'),
        ("task: {errand", "task: {errant", ":5: task needs one of errand"),
        ("boxes: 3", "moves: 3", ":7: happens.moves needs boxes that are moved: add boxes"),
        ("boxes: 3", "boxes: many", ":7: happens.boxes must be a whole number"),
        ("scan_noisy", "scan_nosy", ":8: happens.faults[1].kind must be one of"),
        ("max_vel_x: 0.4", "max_vel_x: fast", "max_vel_x must be a number, got 'fast'"),
        ("max_vel_x: 0.4", "max_val_x: 0.4", ":9: planner.parameters cannot be used: "),
        (
            "dwa_local_planner/DWAPlannerROS",
            "dwa/DVAPlanner",
            ":9: planner.name cannot be used: there is no ",
        ),
        ("seconds: 200", "seconds: 0", ":10: limits.seconds must be positive"),
        ("0-4,9", "9-4", ":11: seeds cannot be used: seeds must be like 0-999"),
    ],
)
def test_an_error_names_file_line_and_key(tmp_path, was, becomes, complaint):
    assert was in ALL_KEYS
    path = written(tmp_path, ALL_KEYS.replace(was, becomes))
    with pytest.raises(SettingsError) as error:
        read_scenario(path)
    assert str(error.value).startswith(str(path)) and complaint in str(error.value)


def test_a_scenario_that_cannot_run_is_named_and_the_others_are_loaded(tmp_path):
    in_a_wall = written(tmp_path, ALL_KEYS.replace("{x: 0.5, y: 0.1, yaw: 0.2}", "{x: 50.0, y: 0.0}"))
    (tmp_path / "good.yaml").write_text(ALL_KEYS.replace("ROOT", str(ROOT)))
    lost = ALL_KEYS.replace("ROOT/map/home.world", "nowhere.world")
    (tmp_path / "lost.yaml").write_text(lost.replace("ROOT", str(ROOT)))
    scenarios, complaints = load_suites([str(tmp_path)])
    assert [scenario.name for scenario in scenarios] == ["good"]
    assert len(complaints) == 2
    assert "lost.yaml" in complaints[0] and "nowhere.world" in complaints[0]
    assert str(in_a_wall) in complaints[1] and "robot.start (50, 0) lies outside the map" in complaints[1]


def test_all_mistakes_of_a_scenario_are_reported_at_once(tmp_path):
    text = """\
abuot: x
world: {fiel: x}
robot: {profile: turtlebto_lidar, start: {x: 0.5, y: left}}
simulation: {noise: worse, range_noise: -1, rainge_noise: 2}
task: {errant: x}
happens:
  boxes: [{x: 1}, {x: a, y: 2}]
  doors: [{width: 20, x: 0, y: 0}]
  people: [{goals: here}, {goals: [[0, 0]], speed: 9}]
  faults: [{kind: scan_nosy}, {kind: scan_noisy, start: -1}]
  faulst: []
planner: {name: nothing/Such, parameters: {DWAPlannerROS: {max_vel_x: fast}}}
limits: {seconds: -3}
seeds: many
"""
    with pytest.raises(SettingsError) as caught:
        read_scenario(written(tmp_path, text))
    lines = [int(line.split(":")[1]) for line in str(caught.value).splitlines()]
    # The parameters in line 12 cannot be judged without the planner.
    assert sorted(lines) == [1, 2, 3, 3, 4, 4, 4, 5, 7, 7, 8, 9, 9, 10, 10, 11, 12, 13, 14]


def test_a_missing_suite_is_refused():
    with pytest.raises(SettingsError, match="nonsense: not a file, a folder or one of scenarios"):
        load_suites(["nonsense"])


@pytest.mark.parametrize("planner", ["Nonsense", "no_such.module/Nonsense"])
def test_a_missing_planner_is_refused_before_the_start(planner):
    with pytest.raises(SettingsError, match=planner):
        load_suites(["home_errand"], ["move_base_lite/MppiPlannerROS", planner])


def test_a_digest_depends_on_the_values_of_a_scenario_and_not_on_its_name(tmp_path):
    scenario = read_scenario(written(tmp_path, ALL_KEYS))
    assert replace(scenario, name="other", about="", seeds=(7,)).digest() == scenario.digest()
    others = [
        scenario.with_planner(""),
        scenario.with_parameters({}),
        replace(scenario, boxes=4),
        replace(scenario, seconds=100.0),
        replace(scenario, faults=()),
    ]
    assert len({scenario.digest(), *(other.digest() for other in others)}) == 6


def test_a_digest_changes_with_a_file_of_the_scenario(tmp_path):
    zones = tmp_path / "zones.yaml"
    zones.write_text((ROOT / "map/zones.yaml").read_text())
    path = written(tmp_path, ALL_KEYS.replace("ROOT/map/zones.yaml", "zones.yaml"))
    before = read_scenario(path).digest()
    zones.write_text(zones.read_text().replace("x: 2.0", "x: 1.9"))
    assert read_scenario(path).digest() != before


OWN_PLANNER = """
from my_planning import costs
from .tools.search import Search
import numpy

class MyPlanner(Search):
    pass
"""


@pytest.fixture
def own_plugins(tmp_path, monkeypatch):
    """Packages with plugins on Python's path, as a user would write them."""
    root = tmp_path / "python"
    for name, text in {
        "my_planning/__init__.py": "",
        "my_planning/planner.py": OWN_PLANNER,
        "my_planning/costs.py": "WEIGHT = 1.0",
        "my_planning/tools/__init__.py": "from my_helpers import clip",
        "my_planning/tools/search.py": "class Search: pass",
        "my_planning/weights.npz": "1",
        "my_helpers.py": "def clip(): pass",
        "my_planning/unused.py": "",
        "network.onnx": "1",
    }.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    monkeypatch.syspath_prepend(str(root))
    yield root
    for name in [each for each in sys.modules if each.startswith("my_")]:
        del sys.modules[name]


PLUGINS = {
    "a local planner": {"planner": "my_planning.planner/MyPlanner"},
    "a global planner": {"parameters": {"base_global_planner": "my_planning.planner/MyPlanner"}},
    "a recovery behavior": {
        "parameters": {"recovery_behaviors": [{"name": "mine", "type": "my_planning.planner/MyPlanner"}]}
    },
    "a layer": {
        "parameters": {"local_costmap": {"plugins": [{"name": "m", "type": "my_planning.planner/MyPlanner"}]}}
    },
}


@pytest.mark.parametrize("plugin", PLUGINS.values(), ids=list(PLUGINS))
def test_a_digest_changes_with_each_file_of_a_plugin(own_plugins, plugin, tmp_path):
    scenario = replace(read_scenario(written(tmp_path, ALL_KEYS)), **plugin)
    digests = {scenario.digest()}
    for changed in ("planner.py", "costs.py", "tools/__init__.py", "tools/search.py", "weights.npz"):
        path = own_plugins / "my_planning" / changed
        path.write_text(path.read_text() + "\n# changed")
        digests.add(scenario.digest())
    (own_plugins / "my_helpers.py").write_text("def clip(): return 1")
    digests.add(scenario.digest())
    assert len(digests) == 7
    (own_plugins / "my_planning/unused.py").write_text("# changed")
    assert scenario.digest() in digests


def test_a_digest_changes_with_a_file_that_a_parameter_names(own_plugins, tmp_path):
    network = own_plugins / "network.onnx"
    parameters = {"MyPlanner": {"network": str(network)}}
    scenario = read_scenario(written(tmp_path, ALL_KEYS)).with_parameters(parameters)
    before = scenario.digest()
    network.write_text("2")
    assert scenario.digest() != before


@pytest.mark.parametrize("path", sorted(FOLDER.glob("home*.yaml")), ids=lambda path: path.stem)
def test_the_included_scenarios_can_be_loaded(path):
    scenarios, complaints = load_suites([str(path)])
    assert complaints == [] and len(scenarios) == 1


def test_seeds_are_lists_of_numbers_and_ranges():
    assert parse_seeds("7") == (7,)
    assert parse_seeds("0-3,2,9") == (0, 1, 2, 3, 9)
    for nonsense in ("", "a", "3-1", "-1", "1-", "0-99999999"):
        with pytest.raises(SettingsError, match="seeds must be like"):
            parse_seeds(nonsense)
