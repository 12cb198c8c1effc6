"""The dock of a command: --dock, or the place ``dock`` of the zones."""

from dataclasses import dataclass

import pytest

from evaluation.options import ErrandOptions, GraphOptions
from planar import Pose2, SettingsError
from supervision.command_line import parse


@dataclass(frozen=True)
class Command(GraphOptions, ErrandOptions):
    """A command with zones and a graph."""


def command(*words: str) -> Command:
    return parse(Command, words, "command")


@pytest.fixture
def zones(tmp_path):
    path = tmp_path / "zones.yaml"
    path.write_text("dock: {x: 1.0, y: -2.0, yaw: 0.5}\n")
    return str(path)


def test_there_is_no_dock_by_default():
    assert command().dock_in_world() is None
    assert "dock" not in command().launch("home_service.launch").arguments


def test_the_dock_is_that_of_the_zones(zones):
    assert command("--zones", zones).dock_in_world() == Pose2(1.0, -2.0, 0.5)
    assert command("--zones", zones).launch("a.launch").arguments["dock"] == "1.0 -2.0 0.5"


def test_the_option_precedes_the_zones(zones):
    assert command("--zones", zones, "--dock", "-3", "4", "-1.5").dock_in_world() == Pose2(-3.0, 4.0, -1.5)


@pytest.mark.parametrize("words", [("nan", "0", "0"), ("1e9", "0", "0")])
def test_a_pose_out_of_range_is_an_error(words):
    with pytest.raises(SettingsError, match="--dock must be a pose"):
        command("--dock", *words).dock_in_world()


def test_a_pose_of_two_numbers_is_refused(capsys):
    with pytest.raises(SystemExit):
        command("--dock", "1", "2")
    assert "expected 3 arguments" in capsys.readouterr().err
