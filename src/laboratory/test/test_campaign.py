"""Campaigns: no result is lost, no run is repeated, and a dead worker costs only its current run."""

import os
import signal
import sqlite3
import threading
from dataclasses import replace

import pytest
from distributed import LocalCluster

from laboratory import commands
from laboratory.campaign import Campaign, ScenarioRun, Workers, campaign
from laboratory.campaign.progress import CampaignProgress
from laboratory.errors import ResultsError, WorkersError
from laboratory.evaluation import EvaluatedScenario, Evaluation
from laboratory.results.result import RunKey
from laboratory.results.store import ResultStore
from laboratory.runner import run_scenario
from laboratory.scenario import read_scenario
from laboratory.suites import FOLDER
from planar import FileWriteError
from supervision.cli import parse

SEEDS = tuple(range(6))


@pytest.fixture(scope="module")
def scenario():
    """A scenario whose runs take about a second."""
    return replace(read_scenario(FOLDER / "home_errand.yaml"), seconds=3.0)


@pytest.fixture(scope="module")
def alone(scenario):
    """Its results in this process."""
    return [same(run_scenario(scenario, seed)) for seed in SEEDS]


def same(result):
    """A result without its wall-clock time."""
    return replace(result, wall_seconds=0.0)


def results_of(evaluation):
    return [same(result) for each in evaluation.evaluated() for result in each.results]


def test_workers_give_the_results_of_one_process_even_if_one_is_killed(scenario, alone, tmp_path):
    evaluation = Evaluation([scenario], SEEDS, tmp_path / "results.sqlite")
    runs, total = evaluation.pending_runs()
    assert total == len(runs) == len(SEEDS)
    killed = threading.Event()
    with Workers(2).client() as client:
        processes = list(client.run(os.getpid).values())
        assert len(processes) == 2

        def kill_one(_mission, _result):
            if not killed.is_set():
                killed.set()
                os.kill(processes[0], signal.SIGKILL)

        Campaign(client, evaluation._store, kill_one, 2).run(runs)
    assert killed.is_set()
    assert results_of(evaluation) == alone
    evaluation.close()


def test_stored_runs_are_not_repeated(scenario, alone, tmp_path):
    path = tmp_path / "results.sqlite"
    store = ResultStore(path)
    for result in alone[:4]:
        store.add(result)
    store.close()
    evaluation = Evaluation([scenario], SEEDS, path)
    runs, total = evaluation.pending_runs()
    assert ([run.seed for run in runs], total) == ([4, 5], 6)
    evaluation.run(Workers(1))
    assert results_of(evaluation) == alone
    assert evaluation.pending_runs()[0] == []
    evaluation.close()


def test_runs_with_an_error_or_of_another_version_are_repeated(alone, tmp_path):
    store = ResultStore(tmp_path / "results.sqlite")
    store.add(alone[0])
    store.add(replace(alone[1], outcome="error"))
    assert store.completed(alone[0].version) == {(alone[0].digest, 0)}
    assert store.completed("other") == set()
    store.add(alone[1])
    assert [result.seed for result in store.results(alone[0].digest, alone[0].version)] == [0, 1]
    store.close()


def test_an_unreadable_results_file_is_named(tmp_path):
    path = tmp_path / "results.sqlite"
    path.write_text("nothing of this kind " * 100)
    with pytest.raises(ResultsError, match=f"{path}: file is not a database"):
        ResultStore(path)


def test_a_damaged_results_file_is_not_reported_as_intact(alone, tmp_path):
    path = tmp_path / "results.sqlite"
    store = ResultStore(path)
    for result in alone:
        store.add(result)
    store.close()
    content = bytearray(path.read_bytes())
    content[4096:] = bytes(len(content) - 4096)
    path.write_bytes(content)
    with pytest.raises(ResultsError, match=f"{path}: .*; the file is damaged: move it away") as caught:
        ResultStore(path).results(alone[0].digest, alone[0].version)
    assert "intact" not in str(caught.value)


def test_a_stored_run_without_an_outcome_is_repeated_and_other_empty_values_are_defaults(alone, tmp_path):
    store = ResultStore(tmp_path / "results.sqlite")
    for result in alone[:3]:
        store.add(result)
    with sqlite3.connect(str(tmp_path / "results.sqlite")) as connection:
        connection.execute("UPDATE results SET outcome = NULL WHERE seed = 0")
        connection.execute("UPDATE results SET collisions = NULL, track = NULL, reason = NULL WHERE seed = 1")
    digest, version = alone[0].digest, alone[0].version
    assert store.completed(version) == {(digest, 1), (digest, 2)}
    found = store.results(digest, version)
    assert found == [replace(alone[1], collisions=0, track=b"", reason=""), alone[2]]
    store.close()


@pytest.mark.parametrize("deaths", [1, 2, 3])
def test_a_worker_that_dies_while_it_starts_is_started_again(deaths, monkeypatch):
    starts = []

    def start(**_):
        starts.append(1)
        if len(starts) <= deaths:
            raise RuntimeError("Nanny failed to start.")
        return LocalCluster(n_workers=0, processes=False, dashboard_address=None)

    monkeypatch.setattr("laboratory.campaign.workers.LocalCluster", start)
    if deaths < 3:
        with Workers(1).client() as client:
            assert client.scheduler_info()["workers"] == {}
    else:
        with pytest.raises(WorkersError, match="cannot be started: Nanny failed to start"), Workers(
            1
        ).client():
            pass


def test_a_missing_scheduler_is_reported(monkeypatch):
    monkeypatch.setattr("laboratory.campaign.workers.CONNECT_TIMEOUT", 1)
    with pytest.raises(WorkersError, match="tcp://127.0.0.1:9: no scheduler"), Workers(
        scheduler="tcp://127.0.0.1:9"
    ).client():
        pass


def test_a_worker_of_another_version_refuses_to_run(scenario):
    with pytest.raises(WorkersError, match="another version of the software"):
        campaign.run_on_worker(scenario, RunKey("digest", 1, "of tomorrow"))


def test_a_run_is_identified_by_scenario_seed_and_version(scenario):
    assert ScenarioRun(scenario, 3, "abc").key[:2] == ("abc", 3)


def test_a_campaign_that_cannot_start_prints_only_the_error(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr("supervision.interruption.raise_when_interrupted", lambda: None)
    monkeypatch.setattr("laboratory.campaign.workers.CONNECT_TIMEOUT", 1)
    arguments = ["evaluate", "home_errand", "--output", str(tmp_path), "--scheduler", "tcp://127.0.0.1:9"]
    with pytest.raises(WorkersError, match="no scheduler"):
        parse(arguments, commands.FOLDER).run()
    assert "0 runs" not in capsys.readouterr().out
    assert [file.name for file in tmp_path.iterdir()] == ["results.sqlite"]


def test_the_first_error_of_a_full_disk_is_reported(monkeypatch, tmp_path, scenario, alone):
    def fill_up(evaluation, workers):
        raise ResultsError("results.sqlite: database or disk is full")

    def write_none(*arguments):
        raise FileWriteError("results.csv: cannot be written")

    monkeypatch.setattr("supervision.interruption.raise_when_interrupted", lambda: None)
    monkeypatch.setattr(Evaluation, "run", fill_up)
    monkeypatch.setattr(Evaluation, "evaluated", lambda evaluation: [EvaluatedScenario(scenario, "d", alone)])
    monkeypatch.setattr("laboratory.results.export.export", write_none)
    with pytest.raises(ResultsError, match="database or disk is full"):
        parse(["evaluate", "home_errand", "--output", str(tmp_path)], commands.FOLDER).run()


def test_progress_includes_the_remaining_time():
    progress = CampaignProgress(10, clock=iter([0.0, 3.0, 6.0]).__next__)
    progress.count(True)
    progress.count(False)
    assert progress.line(6.0) == "  2 of 10 runs completed, 1 succeeded, 20 runs/min, 24 s remaining"
