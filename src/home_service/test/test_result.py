"""What is written of a run follows the schema of result.json, whoever found it."""

import json
from pathlib import Path

import fastjsonschema
import pytest

from home_service import commands
from home_service.judging.verdict import DeliveryRecord
from home_service.options import RunOptions
from home_service.result import Result
from home_service.ros.following import FollowWatch
from home_service.ros.referee import Referee
from planar import Pose2
from planar.maps.places import Place
from run_report import RunRecord, summary

SCHEMA = json.loads((Path(__file__).resolve().parents[1] / "config/result.schema.json").read_text())
VERDICT = {
    "success": True,
    "reason": "picked up and delivered",
    "wall_seconds": 12.5,
    "versions": {"python": "3"},
}


@pytest.fixture
def referee(monkeypatch):
    monkeypatch.setattr("rospy.Subscriber", lambda *_, **__: None)
    referee = Referee({"hall": Place("hall", Pose2())}, say=lambda line: None)
    referee.start()
    referee.ledger.deliveries.append(DeliveryRecord("post", "letter", "hall", "door", pickup_error=0.12345))
    return referee


def test_the_result_of_an_errand_follows_the_schema(referee, tmp_path):
    options = commands.FOLDER.find("home_service")(seed=3, mission=Path("mission.yaml"))
    result = Result(tmp_path)
    result.add(command=options.name, **VERDICT, **options.told())
    result.add(**referee.findings())
    result.add(**summary(RunRecord()))
    result.missing.append("bag: the disk is full")
    result.write()
    written = json.loads((tmp_path / "result.json").read_text())
    fastjsonschema.compile(SCHEMA)(written)
    assert written["command"] == "home_service"
    assert written["mission"] == "mission.yaml"
    assert written["deliveries"][0]["pickup_error"] == 0.1235


def test_every_finding_has_its_place_in_the_schema(referee, monkeypatch):
    found = {**referee.findings(), **FollowWatch("follower").findings(), **summary(RunRecord())}
    assert set(found) <= set(SCHEMA["properties"])


@pytest.mark.parametrize("name", commands.FOLDER.names())
def test_what_a_run_is_told_has_its_place_in_the_schema(name):
    kind = commands.FOLDER.find(name)
    if issubclass(kind, RunOptions):
        assert set(kind().told()) <= set(SCHEMA["properties"])


def test_a_judge_that_never_began_has_found_nothing():
    assert Referee({}, say=lambda line: None).findings() == {}


def test_a_result_that_cannot_be_written_is_missing_not_an_error(tmp_path):
    result = Result(tmp_path / "gone")
    result.write()
    assert result.missing == ["result.json: cannot be written (No such file or directory)"]
