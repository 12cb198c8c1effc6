from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from laboratory.page import page_html
from laboratory.page.maps import heat_map
from laboratory.page.page import comparison_text, repeat_command
from laboratory.results.result import RunResult
from laboratory.scenario import read_scenario
from laboratory.statistics.comparison import compare
from laboratory.statistics.summary import summary
from laboratory.suites import FOLDER

SCENARIO = read_scenario(FOLDER / "home_errand.yaml")
TRACK = np.array([[0.0, 0.0, 0.0, 0.0], [1.0, 0.5, 0.1, 0.0]], dtype=np.float32).tobytes()
WON = RunResult("d", 0, "v", "success", "done", seconds=20.0, driven=9.0, way=8.0, clearance=0.3, track=TRACK)
LOST = replace(WON, seed=1, outcome="collision", reason="hit <a wall>", end_x=0.6, end_y=0.2)


def evaluated(scenario, results):
    return SimpleNamespace(scenario=scenario, results=results, summary=summary(results))


@pytest.fixture(scope="module")
def page():
    dwa = SCENARIO.with_planner("dwa_local_planner/DWAPlannerROS")
    error = RunResult("d", 2, "v", "error", "the world does not load")
    return page_html([evaluated(SCENARIO, [WON, LOST]), evaluated(dwa, [WON, error])], "v1.2")


def test_a_failed_seed_has_its_reason_its_map_and_the_command_that_repeats_it(page):
    assert "hit &lt;a wall&gt;" in page and "<a wall>" not in page
    assert "./scripts/play.sh home_errand --seed 1" in page
    assert "home_errand, seed 1: collision after 20.0 s, 9.0 m" in page
    assert 'class="path truth"' in page


def test_a_run_that_could_not_be_executed_has_no_map(page):
    assert "the world does not load" in page
    assert "--seed 2 --planner dwa_local_planner/DWAPlannerROS" in page


def test_the_page_loads_nothing_from_the_network(page):
    assert "default-src 'none'" in page
    assert "http://" not in page and "https://" not in page


def test_planners_are_on_a_leaderboard(page):
    assert "default of the robot" in page and "dwa_local_planner/DWAPlannerROS" in page
    assert "success: undecided" in page


def test_a_single_planner_has_no_comparison(page):
    alone = page_html([evaluated(SCENARIO, [WON])], "v1.2")
    assert "compared with the first" in page and "compared with the first" not in alone


def test_a_figure_without_values_has_no_column(page):
    without_spl = page_html([evaluated(SCENARIO, [replace(WON, way=None)])], "v1.2")
    assert "<th>SPL</th>" in page and "<th>SPL</th>" not in without_spl


def test_a_heat_map_is_reddest_where_most_failed():
    elsewhere = replace(LOST, end_x=-2.0, end_y=1.0)
    drawn = heat_map(SCENARIO, [LOST, LOST, elsewhere])
    assert '<rect x="0.5" y="-0.5"' in drawn and "2 of 3 ended here" in drawn
    assert 'fill-opacity="0.90"' in drawn and 'fill-opacity="0.57"' in drawn


def test_the_command_names_a_file_outside_of_the_project(tmp_path):
    elsewhere = replace(SCENARIO, file=tmp_path / "my scenario.yaml")
    assert repeat_command(elsewhere, 5) == f"./scripts/play.sh '{tmp_path}/my scenario.yaml' --seed 5"


def test_the_command_of_a_run_over_ros_has_its_options():
    official = replace(SCENARIO.with_planner("official"), is_over_ros=True)
    command = "./scripts/play.sh home_errand --seed 5 --planner official --over ros"
    assert repeat_command(official, 5) == command
    both = replace(official, localizer="official")
    assert repeat_command(both, 5) == command.replace("--over", "--localizer official --over")


def test_a_comparison_is_described_in_one_line():
    assert comparison_text(compare([WON], [replace(WON, seed=7)])) == "no seeds in common"
    assert comparison_text(compare([WON], [WON])) == "success: undecided (+0 −0, p 1)"
