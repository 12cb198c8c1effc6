import math
from argparse import ArgumentTypeError

import pytest

from home_service.cli import main
from home_service.options import goal_list, parse, speed_factor


def test_goals_are_read_from_a_line():
    assert goal_list("1 2 0.5; -3 4e-1 0;") == [[1.0, 2.0, 0.5], [-3.0, 0.4, 0.0]]


@pytest.mark.parametrize("text", ["1 2", "1 2 three", ";", "1 2 3 4"])
def test_malformed_goals_are_refused(text):
    with pytest.raises(ArgumentTypeError):
        goal_list(text)


@pytest.mark.parametrize("text", ["-1", "fast", "nan", "1e9"])
def test_a_senseless_speed_is_refused(text):
    with pytest.raises(ArgumentTypeError):
        speed_factor(text)


@pytest.mark.parametrize(
    "command", ["launch", "test_navigation", "pick_objects", "add_marker", "home_service"]
)
def test_every_command_explains_itself(command, capsys):
    with pytest.raises(SystemExit) as stop:
        parse([command, "--help"])
    assert stop.value.code == 0
    assert "--seed" in capsys.readouterr().out


@pytest.mark.parametrize(
    "arguments, expected",
    [
        (["home_service"], 900.0),
        (["home_service", "--serve"], math.inf),
        (["home_service", "--serve", "--timeout", "5"], 5.0),
        (["launch"], math.inf),
        (["test_navigation"], math.inf),
        (["test_navigation", "--goals", "1 2 3"], 900.0),
        (["rehearse"], 600.0),
    ],
)
def test_what_a_person_ends_has_no_time_out_of_its_own(arguments, expected):
    assert parse(arguments).timeout == expected


@pytest.mark.parametrize("option", ["world", "map", "zones"])
def test_a_missing_file_is_named_and_nothing_is_started(option, tmp_path, capsys):
    missing = tmp_path / "missing.file"
    code = main(["home_service", f"--{option}", str(missing), "--output", str(tmp_path / "runs")])
    assert code == 2
    assert str(missing) in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
