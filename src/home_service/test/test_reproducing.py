"""Runs that cannot be made again by reproduce.sh."""

import json

import pytest

from home_service.reproducing import reproduce
from planar import SettingsError


def test_a_run_of_another_packages_command_is_left_to_that(tmp_path):
    result = {"command": "play", "arguments": ["home errand", "--seed", "3"], "hash": "0", "versions": {}}
    (tmp_path / "result.json").write_text(json.dumps(result))
    (tmp_path / "trace.txt").write_text("")
    with pytest.raises(
        SettingsError, match="only its own command runs this again: ./scripts/play.sh 'home errand'"
    ):
        reproduce(tmp_path)
