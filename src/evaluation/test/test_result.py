"""All fields of result.json follow its schema."""

import json
from pathlib import Path

import fastjsonschema
import pytest

from evaluation.consumers.referee import Referee
from evaluation.event_stream import EventStream
from evaluation.options import RunOptions
from evaluation.result import ResultFile, grouped_by_reason
from evaluation.verdict import DeliveryRecord
from home_service import commands
from home_service.follow_monitor import FollowMonitor
from planar import FileWriteError, Pose2
from planar.maps.places import NamedPlace
from run_report import RunRecord, summary
from supervision import run_folder

SCHEMA = json.loads((Path(__file__).resolve().parents[1] / "config/result.schema.json").read_text())
VERDICT = {
    "success": True,
    "reason": "picked up and delivered",
    "wall_seconds": 12.5,
    "versions": {"python": "3"},
}


@pytest.fixture
def referee():
    referee = Referee({"hall": NamedPlace("hall", Pose2())}, log=lambda line: None)
    referee.attach(EventStream())
    referee.mission_record.deliveries.append(
        DeliveryRecord("post", "letter", "hall", "door", pickup_error=0.12345)
    )
    return referee


def test_the_result_of_an_errand_follows_the_schema(referee, tmp_path):
    options = commands.FOLDER.find("home_service")(seed=3, mission=Path("mission.yaml"))
    result = ResultFile(tmp_path)
    result.add(command=options.name, **VERDICT, **options.result_fields())
    result.add(**referee.result_fields())
    result.add(**summary(RunRecord()))
    result.missing.append("bag: the disk is full")
    result.write()
    written = json.loads((tmp_path / "result.json").read_text())
    fastjsonschema.compile(SCHEMA)(written)
    assert written["command"] == "home_service"
    assert written["mission"] == "mission.yaml"
    assert written["deliveries"][0]["pickup_error"] == 0.1235


def test_every_result_field_is_in_the_schema(referee):
    found = {**referee.result_fields(), **FollowMonitor("follower").result_fields(), **summary(RunRecord())}
    assert set(found) <= set(SCHEMA["properties"])


@pytest.mark.parametrize("name", commands.FOLDER.names())
def test_the_options_of_a_run_are_in_the_schema(name):
    kind = commands.FOLDER.find(name)
    if issubclass(kind, RunOptions):
        assert set(kind().result_fields()) <= set(SCHEMA["properties"])


def test_a_result_that_cannot_be_written_has_a_reason(tmp_path):
    result = ResultFile(tmp_path / "gone")
    result.write()
    assert result.gap == "result.json: cannot be written (No such file or directory)"
    assert result.all_missing == [result.gap]


def test_an_outdated_result_is_deleted(tmp_path, monkeypatch):
    result = ResultFile(tmp_path)
    result.write()
    monkeypatch.setattr(run_folder, "write_atomically", full_disk)
    result.write()
    assert list(tmp_path.iterdir()) == []
    assert result.gap == "result.json: cannot be written (No space left on device)"


def test_the_old_result_is_deleted_to_make_room_for_the_new_one(tmp_path, monkeypatch):
    """A disk with room for one."""
    result = ResultFile(tmp_path)
    result.write()
    write = run_folder.write_atomically
    monkeypatch.setattr(
        run_folder, "write_atomically", lambda path, data: (full_disk if path.exists() else write)(path, data)
    )
    result.add(**VERDICT)
    result.write()
    assert json.loads((tmp_path / "result.json").read_text())["reason"] == VERDICT["reason"]
    assert result.gap is None


def test_missing_files_are_grouped_by_reason():
    full = "cannot be written (No space left on device)"
    missing = [f"run.png: {full}", "bag: 2.bag was not closed", f"report.html: {full}", f"run.png: {full}"]
    assert grouped_by_reason(missing) == [f"run.png, report.html: {full}", "bag: 2.bag was not closed"]


def full_disk(path, data):
    raise FileWriteError(f"{path}: cannot be written (No space left on device)")
