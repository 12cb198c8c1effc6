"""Missions over processes: nothing is lost, nothing is played twice, a dead worker costs only its mission."""

import os
import signal
import threading
from dataclasses import replace

import pytest

from home_service.cli import parse
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

SEEDS = tuple(range(6))


@pytest.fixture(scope="module")
def scenario():
    """One that takes a second or so."""
    return replace(read_scenario(FOLDER / "home_errand.yaml"), seconds=3.0)


@pytest.fixture(scope="module")
def alone(scenario):
    """What comes of it in this process."""
    return [same(run_scenario(scenario, seed)) for seed in SEEDS]


def same(result):
    """Without what depends on the machine."""
    return replace(result, wall_seconds=0.0)


def results_of(evaluation):
    return [same(result) for each in evaluation.evaluated() for result in each.results]


def test_workers_make_what_one_process_makes_also_if_one_of_them_is_killed(scenario, alone, tmp_path):
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


def test_what_has_been_played_is_not_played_again(scenario, alone, tmp_path):
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


def test_an_error_is_worth_another_try_and_other_software_plays_anew(alone, tmp_path):
    store = ResultStore(tmp_path / "results.sqlite")
    store.add(alone[0])
    store.add(replace(alone[1], outcome="error"))
    assert store.completed(alone[0].version) == {(alone[0].digest, 0)}
    assert store.completed("other") == set()
    store.add(alone[1])
    assert [result.seed for result in store.results(alone[0].digest, alone[0].version)] == [0, 1]
    store.close()


def test_a_file_that_holds_no_results_is_named(tmp_path):
    path = tmp_path / "results.sqlite"
    path.write_text("nothing of this kind " * 100)
    with pytest.raises(ResultsError, match=f"{path}: file is not a database"):
        ResultStore(path)


def test_a_scheduler_that_is_not_there_is_told(monkeypatch):
    monkeypatch.setattr("laboratory.campaign.workers.CONNECT_TIMEOUT", 1)
    with pytest.raises(WorkersError, match="tcp://127.0.0.1:9: no scheduler"), Workers(
        scheduler="tcp://127.0.0.1:9"
    ).client():
        pass


def test_a_worker_of_another_version_refuses(scenario):
    with pytest.raises(WorkersError, match="another version of the software"):
        campaign.run_on_worker(scenario, RunKey("digest", 1, "of tomorrow"))


def test_a_mission_has_a_key_of_scenario_seed_and_version(scenario):
    assert ScenarioRun(scenario, 3, "abc").key[:2] == ("abc", 3)


def test_a_campaign_that_never_began_tells_nothing_but_why(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr("supervision.interruption.raise_when_interrupted", lambda: None)
    monkeypatch.setattr("laboratory.campaign.workers.CONNECT_TIMEOUT", 1)
    words = ["evaluate", "home_errand", "--output", str(tmp_path), "--scheduler", "tcp://127.0.0.1:9"]
    with pytest.raises(WorkersError, match="no scheduler"):
        parse(words, commands.FOLDER).run()
    assert "0 runs" not in capsys.readouterr().out
    assert [file.name for file in tmp_path.iterdir()] == ["results.sqlite"]


def test_a_full_disk_is_told_of_the_file_that_it_kept_from_being_written_first(
    monkeypatch, tmp_path, scenario, alone
):
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


def test_progress_tells_how_long_it_will_take():
    progress = CampaignProgress(10, clock=iter([0.0, 3.0, 6.0]).__next__)
    progress.count(True)
    progress.count(False)
    assert progress.line(6.0) == "  2 of 10 runs completed, 1 succeeded, 20 runs/min, 24 s remaining"
