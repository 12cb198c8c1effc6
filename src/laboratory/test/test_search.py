"""Searches are repeatable, resumable, and find the minimum."""

import math
from dataclasses import replace

import pytest
import yaml
from optuna.distributions import FloatDistribution

from laboratory.results.result import RunResult
from laboratory.scenario import read_scenario
from laboratory.search.case_file import scenario_text, write_case
from laboratory.search.cases import Case, CaseSpace, NoiseProfile
from laboratory.search.falsification import robustness, shrink_case
from laboratory.search.study import BATCH, Study
from laboratory.search.tuning import cost, nested, parameter_file_text, read_space, with_values
from laboratory.suites import FOLDER
from laboratory.worlds.boxes import BOX_SPACING
from laboratory.worlds.people import PedestrianRoute
from planar import Pose2, SettingsError
from sim_bridge.faults import Fault

ERRAND = FOLDER / "home_errand.yaml"
SPACE = {"x": FloatDistribution(-2.0, 2.0), "y": FloatDistribution(-2.0, 2.0)}
BOX, WALK = Pose2(1.0, 2.0, 0.5), PedestrianRoute(((1.0, 1.0), (2.0, 2.0)), 0.8)
FAULT = Fault("scan_noisy", 2.0, 4.0, 0.1)


def bowl(batch):
    return [(values["x"] - 1.0) ** 2 + (values["y"] + 0.5) ** 2 for values in batch]


def asked(path, trials, stop_after=math.inf):
    """All values a search samples; after ``stop_after`` batches it is interrupted in the middle of one."""
    seen = []

    def costs_of(batch):
        if len(seen) >= stop_after * BATCH:
            raise KeyboardInterrupt
        seen.extend(batch)
        return bowl(batch)

    study = Study(path, "bowl", SPACE, seed=3)
    try:
        study.run(trials, costs_of)
    except KeyboardInterrupt:
        return seen
    return seen, study.best


def test_a_search_approaches_the_minimum(tmp_path):
    _, best = asked(tmp_path / "journal", 64)
    assert math.hypot(best["x"] - 1.0, best["y"] + 0.5) < 0.3


def test_an_interrupted_search_continues_with_the_same_values(tmp_path):
    whole, best = asked(tmp_path / "whole", 20)
    first = asked(tmp_path / "stopped", 20, stop_after=1)
    rest, again = asked(tmp_path / "stopped", 20)
    assert first + rest == whole and again == best


def test_an_unusable_journal_is_named(tmp_path):
    with pytest.raises(Exception, match="cannot be used as a journal"):
        Study(tmp_path, "bowl", SPACE, 0)


def test_cases_stay_within_their_space():
    base = read_scenario(ERRAND)
    case_space = CaseSpace(boxes=3, people=2, faults=1)
    values = {name: 0.4 for name in case_space.space()}
    values.update({"seed": 7, "noise": "bad", "fault0/kind": "scan_nan", "fault0/start": 3.0})
    case = case_space.case(base, {**values, "fault0/seconds": 2.0})
    boxes = case.of(Pose2)
    assert [len(case.of(kind)) for kind in (Pose2, PedestrianRoute, Fault, NoiseProfile)] == [3, 2, 1, 1]
    gaps = [a.distance_to(b) for number, a in enumerate(boxes) for b in boxes[:number]]
    assert min(gaps) >= BOX_SPACING - 0.01, "boxes leave a passage, even if all are sampled at one position"
    scenario = case.scenario(base)
    assert scenario.simulation.encoder_scale > base.simulation.encoder_scale
    assert scenario.simulation.scan_rate == base.simulation.scan_rate
    arena = scenario.arena(7)
    assert sum(body.name.startswith("box_") for body in arena.world.bodies) == 3
    assert len(arena.world.walkers) == 2
    assert scenario.faults == (Fault("scan_nan", 3.0, 5.0, scenario.faults[0].strength),)


def test_shrinking_leaves_only_the_necessary_elements():
    case = Case(4, (BOX, WALK, FAULT, NoiseProfile("high")))
    attempts = []

    def fails(smaller):
        attempts.append(smaller)
        return WALK in smaller.elements and NoiseProfile("high") in smaller.elements

    assert shrink_case(case, fails).elements == (WALK, NoiseProfile("high"))
    assert len(attempts) < 12
    assert shrink_case(case, lambda smaller: True).elements == ()
    assert shrink_case(case, lambda smaller: False) == case


def test_a_failure_is_less_robust_than_any_success_and_an_error_does_not_count():
    won = RunResult("d", 1, "v", "success", "", seconds=30.0, clearance=0.3, localization_max=0.1)
    close = replace(won, clearance=0.2)
    assert robustness(close, 600.0) < robustness(won, 600.0)
    assert robustness(replace(won, seconds=500.0), 600.0) < robustness(won, 600.0)
    assert robustness(replace(won, outcome="timeout"), 600.0) < 0.0 < robustness(close, 600.0)
    assert robustness(replace(won, outcome="error"), 600.0) >= robustness(won, 600.0)


def test_a_case_is_written_as_an_equal_scenario(tmp_path):
    base = read_scenario(ERRAND)
    case = Case(4, (BOX, WALK, FAULT, NoiseProfile("high")))
    path = write_case(base, case, RunResult("d", 4, "v", "timeout", "too late"), tmp_path)
    again = read_scenario(path)
    assert again.digest() == case.scenario(base).digest()
    assert again.seeds == (4,) and "too late" in again.about
    nothing = yaml.safe_load(scenario_text(base, Case(4, ()), "", tmp_path))
    assert "happens" not in nothing


def test_parameters_are_nested_as_for_move_base(tmp_path):
    path = tmp_path / "space.yaml"
    path.write_text("Planner: {speed: [0.1, 0.5], Inner: {weight: [1, 2]}}\npatience: [1.0, 5.0]\n")
    space = read_space(path)
    assert {name: (each.low, each.high) for name, each in space.items()} == {
        "Planner/speed": (0.1, 0.5),
        "Planner/Inner/weight": (1.0, 2.0),
        "patience": (1.0, 5.0),
    }
    values = {"Planner/speed": 0.2, "Planner/Inner/weight": 1.5, "patience": 2.0}
    assert nested(values) == {"Planner": {"speed": 0.2, "Inner": {"weight": 1.5}}, "patience": 2.0}
    assert yaml.safe_load(parameter_file_text(values)) == nested(values)


def test_an_invalid_space_is_reported_with_line_and_key(tmp_path):
    path = tmp_path / "space.yaml"
    path.write_text("Planner:\n  speed: [0.5, 0.1]\n")
    with pytest.raises(SettingsError, match=r"space.yaml:2: Planner.speed must be two numbers, the lesser"):
        read_space(path)


def test_the_default_space_contains_only_known_parameters(tmp_path):
    base = read_scenario(ERRAND)
    space = read_space(FOLDER / "tuning/mppi.yaml")
    values = {name: (each.low + each.high) / 2.0 for name, each in space.items()}
    text = yaml.safe_load(ERRAND.read_text().replace("../map", str(FOLDER.parent / "map")))
    path = tmp_path / "tuned.yaml"
    path.write_text(yaml.safe_dump({**text, "planner": {"parameters": nested(values)}}))
    assert read_scenario(path).parameters == with_values(base, values).parameters


def test_a_failed_run_costs_more_than_any_that_succeeds():
    base = replace(read_scenario(ERRAND), seconds=100.0)
    won = RunResult("d", 1, "v", "success", "", seconds=30.0)
    assert cost(base, [won, replace(won, seconds=40.0)]) == 35.0
    assert cost(base, [won, replace(won, outcome="collision", seconds=5.0)]) == 115.0
