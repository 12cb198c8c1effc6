"""Runs that reproduce.sh cannot repeat."""

import json

import pytest

from home_service.reproducing import reproduce
from planar import SettingsError


def test_a_command_of_another_package_is_not_run(tmp_path):
    result = {"command": "play", "arguments": ["home errand", "--seed", "3"], "hash": "0", "versions": {}}
    (tmp_path / "result.json").write_text(json.dumps(result))
    (tmp_path / "trace.txt").write_text("")
    with pytest.raises(
        SettingsError, match="only its own command runs this again: ./scripts/play.sh 'home errand'"
    ):
        reproduce(tmp_path)


def test_another_processor_is_reported_before_the_run_is_repeated(tmp_path, capsys):
    result = {"command": "play", "arguments": [], "hash": "0", "versions": {"processor": "486DX2"}}
    (tmp_path / "result.json").write_text(json.dumps(result))
    (tmp_path / "trace.txt").write_text("")
    with pytest.raises(SettingsError):
        reproduce(tmp_path)
    assert ", was 486DX2" in capsys.readouterr().out
