"""The result of a project follows the schema of result.json."""

import json
from pathlib import Path
from types import SimpleNamespace

import fastjsonschema
import pytest

from evaluation.event_stream import EventStream
from evaluation.events import SUCCEEDED, GoalEnded, GoalRequested, MarkerUpdated, TruthUpdated
from planar import Pose2
from run_project import cli
from run_project.judging.run_record import ProjectRunRecord
from run_project.options import parse
from run_project.preparation.building import Workspace
from run_project.ros.project_run import ProjectCommand
from supervision.display import Display
from supervision.interruption import INTERRUPTED, RunInterruptedError

SCHEMA = Path(__file__).resolve().parents[3] / "evaluation/config/result.schema.json"


class FakeRun:
    """Fake of a run in which a goal is reached, or which is interrupted."""

    def __init__(self, is_interrupted):
        record, events = ProjectRunRecord(lambda line: None), EventStream()
        record.attach(events)
        for event in (
            GoalRequested(1.0, "goal", "map", Pose2(1.0, 0.5)),
            TruthUpdated(1.5, Pose2(1.0, 0.6)),
            GoalEnded(2.0, "goal", SUCCEEDED, ""),
            MarkerUpdated(3.0, "cube", 0, (1.0, 0.5, 0.0)),
        ):
            events.publish(event)
        self.observer = SimpleNamespace(record=record, simulated_time=12.34)
        self.user = None
        self.is_over_time = False
        self._is_interrupted = is_interrupted

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def watch(self, timeout):
        if self._is_interrupted:
            raise RunInterruptedError


@pytest.mark.parametrize("is_interrupted, code", [(False, 0), (True, INTERRUPTED)])
def test_the_result_of_a_project_follows_the_published_schema(is_interrupted, code, tmp_path, monkeypatch):
    monkeypatch.setattr(cli, "ProjectRun", lambda *_: FakeRun(is_interrupted))
    (tmp_path / "log").mkdir()
    (tmp_path / "log/window.log").write_text("[ERROR] [12.0]: no map\n")
    command = ProjectCommand(["true"], tmp_path, {}, tmp_path)
    workspace = Workspace(tmp_path, tmp_path, {}, tmp_path, missing={"rtabmap": "not there"})
    about = {"project": "/home/user", "script": "home_service.sh"}
    options = parse(["/home/user", "--seed", "4"])
    assert cli.run_command(options, command, tmp_path, workspace, Display(), about) == code
    result = json.loads((tmp_path / "result.json").read_text())
    fastjsonschema.compile(json.loads(SCHEMA.read_text()))(result)
    assert result["goals"][0]["status"] == "succeeded"
    assert result["left_out"] == {"rtabmap": "not there"}
    assert result["complaints"] == ["window: [ERROR] [12.0]: no map"]


def test_arguments_after_two_dashes_are_for_the_script():
    options = parse(["project", "--rviz", "--", "--seed", "4"])
    assert options.script_arguments == ("--seed", "4")
    assert options.seed == 0
    assert options.effective_speed == 1.0


@pytest.mark.parametrize(("more", "is_off_screen"), [([], True), (["--rviz"], False)])
def test_opencv_windows_are_off_screen_without_rviz(tmp_path, more, is_off_screen):
    environment = cli.window_environment(parse([str(tmp_path), *more]), tmp_path / "log")
    assert (environment.get("QT_QPA_PLATFORM") == "offscreen") == is_off_screen
