from dataclasses import replace

import numpy as np
import pytest

from laboratory.evaluation import EvaluatedScenario
from laboratory.report import regressions, summary_lines, violated_requirements
from laboratory.results.export import export
from laboratory.results.result import RunResult
from laboratory.scenario import read_scenario
from laboratory.statistics.comparison import compare
from laboratory.statistics.requirement import parse_requirement
from laboratory.statistics.summary import mean, share, success_weighted_by_path_length, summary
from laboratory.suites import FOLDER
from planar import SettingsError

WON = RunResult("d", 0, "v", "success", "", seconds=20.0, driven=10.0, way=8.0, clearance=0.3, turning=0.5)


def runs(outcomes, **others):
    return [replace(WON, seed=seed, outcome=outcome, **others) for seed, outcome in enumerate(outcomes)]


def test_a_share_has_wilsons_interval():
    # Brown, Cai and DasGupta, "Interval estimation for a binomial proportion" (2001), formula (4).
    z, n, p = 1.959964, 100, 0.95
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * np.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    assert share(95, 100) == pytest.approx((0.95, middle - half, middle + half), abs=1e-6)
    assert share(1000, 1000).low == pytest.approx(0.99617, abs=1e-5)
    assert share(0, 0).low == 0.0


def test_a_mean_has_a_bootstrap_interval_that_is_the_same_each_time():
    values = np.random.default_rng(1).normal(5.0, 2.0, 400).tolist()
    first = mean(values)
    assert first == mean(values)
    # 1.96 standard errors on either side; the bootstrap's own noise is a few per cent of that.
    assert (first.high - first.low) / 2 == pytest.approx(1.96 * np.std(values) / 20, rel=0.1)
    assert mean([3.0]) == (3.0, 3.0, 3.0)


def test_figures_of_runs():
    totals = summary([*runs(["success"] * 3), replace(WON, seed=9, outcome="collision", seconds=5.0)])
    assert totals.outcomes["success"] == 3 and totals.outcomes["collision"] == 1
    assert totals.figures["success"].value == 0.75 and totals.figures["seconds"].value == 20.0
    assert totals.figures["spl"].value == pytest.approx(0.75 * 0.8)
    assert "localization" not in totals.figures


def test_success_weighted_by_path_length_is_at_most_one():
    assert success_weighted_by_path_length(replace(WON, driven=7.0)) == 1.0
    assert success_weighted_by_path_length(replace(WON, outcome="timeout")) == 0.0
    assert success_weighted_by_path_length(replace(WON, way=None)) is None


def test_planners_are_compared_on_the_same_seeds_by_an_exact_test():
    first = runs(["success"] * 11 + ["timeout"] * 9)
    second = runs(["success"] * 10 + ["timeout"] + ["success"] * 8 + ["timeout"])
    found = compare(first, second)
    assert (found.pairs, found.gained, found.lost) == (20, 8, 1)
    # Two-sided binomial: 2 (C(9, 0) + C(9, 1)) / 2^9.
    assert found.p_success == pytest.approx(20 / 512)
    assert found.success == "better" and compare(second, first).success == "worse"
    assert found.time == "undecided"


def test_a_small_difference_is_undecided():
    assert compare(runs(["success"] * 9 + ["timeout"]), runs(["success"] * 10)).success == "undecided"
    assert compare([], runs(["success"])).success == "undecided"


def test_a_planner_that_is_always_a_second_slower_is_worse():
    slower = runs(["success"] * 12, seconds=21.0)
    found = compare(runs(["success"] * 12), slower)
    assert found.seconds is not None and found.seconds.value == 1.0
    assert (found.success, found.time) == ("undecided", "worse")


def test_a_requirement_is_parsed_and_checked_against_figures():
    figures = summary(runs(["success"] * 98 + ["timeout"] * 2)).figures
    assert parse_requirement("success >= 0.98").is_met(figures)
    assert not parse_requirement("success>0.98").is_met(figures)
    assert parse_requirement("collision <= 0").is_met(figures)
    assert not parse_requirement("localization < 1").is_met(figures)
    with pytest.raises(SettingsError, match='unknown figure "sucess" .did you mean "success"'):
        parse_requirement("sucess >= 0.9")
    with pytest.raises(SettingsError, match='must be like "success >= 0.99"'):
        parse_requirement("always")


def evaluated(outcomes, planner="", **others):
    scenario = read_scenario(FOLDER / "home_errand.yaml").with_planner(planner)
    return EvaluatedScenario(scenario, "d", runs(outcomes, **others))


def test_a_violated_requirement_names_its_scenario():
    rules = [parse_requirement("success >= 1")]
    assert violated_requirements([evaluated(["timeout"])], rules) == [
        "home_errand: requirement not met: success >= 1"
    ]


def test_a_regression_is_named():
    good, bad = evaluated(["success"] * 10), evaluated(["timeout"] * 8 + ["success"] * 2)
    (line,) = regressions([bad], [good])
    assert line.startswith("home_errand: worse than before: success: worse (+0 −8")
    assert regressions([good], [bad]) == [] and regressions([good], []) == []


def test_the_report_lists_figures_and_compares_planners():
    lines = summary_lines([evaluated(["success"] * 4), evaluated(["success"] * 3 + ["collision"], "other")])
    assert lines[0] == "home_errand: 4 runs: 4 success"
    assert "home_errand [other]: 4 runs: 3 success, 1 collision" in lines
    assert lines[-1] == "  compared with home_errand: success: undecided (+0 −1, p 1)"
    assert summary_lines([evaluated([])]) == ["home_errand: 0 runs: none completed"]


def test_results_are_exported_as_tables(tmp_path):
    import pandas

    scenario = read_scenario(FOLDER / "home_errand.yaml")
    export([(scenario, runs(["success", "timeout"]))], tmp_path)
    tables = pandas.read_csv(tmp_path / "results.csv"), pandas.read_parquet(tmp_path / "results.parquet")
    for table in tables:
        assert list(table["outcome"]) == ["success", "timeout"]
        assert list(table["scenario"]) == ["home_errand"] * 2 and "track" not in table
