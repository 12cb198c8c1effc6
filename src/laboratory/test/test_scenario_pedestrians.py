"""Pedestrians of scenarios: kinds, start positions and social metrics."""

import sqlite3
from dataclasses import replace

import numpy as np
import pytest

from laboratory.results.result import RunResult
from laboratory.results.social_metrics import seconds_still, social_metrics
from laboratory.results.store import COLUMNS, ResultStore
from laboratory.runner import run_scenario
from laboratory.scenario import read_scenario
from laboratory.suites import FOLDER
from laboratory.worlds.people import SPACING, START_CLEARANCE, Pedestrians
from planar import SettingsError

SCENARIO = FOLDER / "home_people.yaml"


def written(tmp_path, people):
    path = tmp_path / "scenario.yaml"
    text = SCENARIO.read_text().replace("../map", str(FOLDER.parent / "map"))
    path.write_text(text.replace("people: 4", f"people: {people}"))
    return path


def test_their_number_is_as_requested_and_each_seed_has_different_ones():
    scenario = read_scenario(SCENARIO)
    crowds = [scenario.arena(seed).world.walkers for seed in range(12)]
    assert [len(walkers) for walkers in crowds] == [4] * 12
    again = scenario.arena(5).world.walkers
    assert [walker.goals_xy.tolist() for walker in again] == [w.goals_xy.tolist() for w in crowds[5]]
    firsts = np.array([[walker.goals_xy[0] for walker in walkers] for walkers in crowds])
    assert len(np.unique(firsts.reshape(-1, 2), axis=0)) > 40
    assert np.hypot(*firsts.reshape(-1, 2).T).min() > START_CLEARANCE
    for starts in firsts:
        gaps = [np.hypot(*(a - b)) for n, a in enumerate(starts) for b in starts[:n]]
        assert min(gaps) > SPACING
    kinds = {(walker.radius, len(walker.goals_xy) > 1, walker.group > 0) for ws in crowds for walker in ws}
    assert {(0.2, True, False), (0.15, True, False), (0.2, False, False), (0.2, True, True)} <= kinds


def test_numbers_can_be_given_by_kind(tmp_path):
    people = "{adults: 1, children: 2, standing: 1, groups: [3]}"
    scenario = read_scenario(written(tmp_path, people))
    assert scenario.people == Pedestrians(adults=1, children=2, standing=1, groups=(3,))
    walkers = scenario.arena(0).world.walkers
    assert [walker.group > 0 for walker in walkers] == [False] * 3 + [True] * 3 + [False]
    assert [walker.height for walker in walkers] == [1.7, 1.1, 1.1, 1.7, 1.7, 1.7, 1.7]
    assert [len(walker.goals_xy) for walker in walkers] == [4] * 6 + [1]


def test_routes_can_be_given(tmp_path):
    people = "[{goals: [[1.0, 2.0], [2, 3]], speed: 0.7}, {goals: [[0.5, 2.0]]}]"
    walkers = read_scenario(written(tmp_path, people)).arena(0).world.walkers
    assert [walker.goals_xy.tolist() for walker in walkers] == [[[1.0, 2.0], [2.0, 3.0]], [[0.5, 2.0]]]
    assert [walker.speed for walker in walkers] == [0.7, 1.0]


@pytest.mark.parametrize(
    ("people", "complaint"),
    [
        ("-1", ":4: happens.people must be"),
        ("many", ":4: happens.people must be a table"),
        ("{adlts: 1}", ':4: unknown key "happens.people.adlts" (did you mean "adults"?)'),
        ("{groups: [1]}", ":4: happens.people.groups must be a list of group sizes"),
        ("{groups: 2}", ":4: happens.people.groups must be a list of group sizes"),
        ("[{goals: []}]", ":4: happens.people[1].goals must be a list of [x, y]"),
        ("[{goals: [[1, a]]}]", ":4: happens.people[1].goals must be a list of [x, y]"),
        ("[{goals: [[1, 2]], speed: 0}]", ":4: happens.people[1].speed must be positive"),
        ("50", ":4: happens.people must be at most 40"),
    ],
)
def test_an_error_names_line_and_key(tmp_path, people, complaint):
    with pytest.raises(SettingsError) as caught:
        read_scenario(written(tmp_path, people))
    assert complaint in str(caught.value)


def test_too_many_pedestrians_are_an_error():
    scenario = replace(read_scenario(SCENARIO), people=Pedestrians(adults=400))
    result = run_scenario(scenario, 0)
    assert result.outcome == "error" and "not enough space for so many people" in result.reason


def test_a_run_among_pedestrians_is_repeatable_and_measured():
    scenario = read_scenario(SCENARIO)
    first, again = run_scenario(scenario, 3), run_scenario(scenario, 3)
    assert replace(first, wall_seconds=0.0) == replace(again, wall_seconds=0.0)
    assert first.hash != run_scenario(replace(scenario, people=Pedestrians()), 3).hash
    assert first.is_success, first.reason
    shares = (first.intimate, first.personal, first.social)
    assert all(share is not None and 0.0 <= share <= 1.0 for share in shares) and sum(shares) <= 1.0
    assert first.person_nearest is not None and 0.3 < first.person_nearest < first.person_distance
    assert first.social_work is not None and first.social_work > 0.0
    assert first.ran_into_robot == 0


def test_personal_spaces_are_those_of_the_nearest_person():
    track = np.column_stack((np.arange(5) * 0.1, np.zeros((5, 3))))
    people = np.zeros((5, 2, 5))
    people[:, 0, 0], people[:, 1, 0] = (0.4, 0.45, 1.0, 1.2, 4.0), 9.0
    found = social_metrics(track, people)
    assert (found.intimate, found.personal, found.social) == (0.2, 0.4, 0.2)
    assert found.person_nearest == pytest.approx(0.4)
    assert found.person_distance == pytest.approx(7.05 / 5)
    assert social_metrics(track, np.empty((5, 0, 5))).intimate is None


def test_social_work_decreases_with_distance():
    track = np.column_stack((np.arange(5) * 0.1, np.zeros((5, 3))))
    works = []
    for distance in (0.6, 1.2, 3.0):
        people = np.tile((distance, 0.0, 0.0, 0.0, 0.2), (5, 1, 1))
        works.append(social_metrics(track, people).social_work)
    assert works[0] > 2.0 * works[1] > 20.0 * works[2] > 0.0


def test_time_without_motion_is_measured():
    x = np.array([0.0, 0.0, 0.1, 0.2, 0.2])
    yaw = np.array([0.0, 0.0, 0.0, 0.0, 0.1])
    track = np.column_stack((np.arange(5) * 0.5, x, np.zeros(5), yaw))
    assert seconds_still(track) == pytest.approx(0.5), "turning counts as motion"


def test_an_old_results_file_gets_the_new_columns(tmp_path):
    path = tmp_path / "results.sqlite"
    columns = [f"{name} {kind}" for name, kind in COLUMNS.items() if name != "social_work"]
    with sqlite3.connect(str(path)) as connection:
        connection.execute(
            f"CREATE TABLE results ({', '.join(columns)}, PRIMARY KEY (digest, seed, version))"
        )
        row = "('d', 1, 'v', 'success', 'fine')"
        connection.execute(f"INSERT INTO results (digest, seed, version, outcome, reason) VALUES {row}")
    store = ResultStore(path)
    store.add(RunResult("d", 2, "v", "success", "fine", social_work=1.5))
    assert [run.social_work for run in store.results("d", "v")] == [None, 1.5]
    store.close()
