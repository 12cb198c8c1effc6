import pytest

from home_service.ros import mapping
from supervision.errors import LaunchError


@pytest.fixture()
def rosrun(tmp_path, monkeypatch):
    """Writes a program that is called instead of rosrun."""
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")

    def write(text):
        program = tmp_path / "rosrun"
        program.write_text(f"#!/bin/sh\n{text}\n")
        program.chmod(0o755)

    return write


def test_a_map_saver_that_does_not_end_is_an_error_of_one_line(rosrun, tmp_path, monkeypatch):
    rosrun("exec sleep 60")
    monkeypatch.setattr(mapping, "SAVE_SECONDS", 0.2)
    with pytest.raises(LaunchError, match="map_saver: not over after 0.2 s$"):
        mapping.save_map(tmp_path, None)
    monkeypatch.setattr(mapping, "SAVE_SECONDS", 2.0)
    rosrun("echo Waiting for the map; exec sleep 60")
    with pytest.raises(LaunchError, match="map_saver: .*; its last words: Waiting for the map$"):
        mapping.save_map(tmp_path, None)


def test_a_map_saver_without_a_map_says_so(rosrun, tmp_path):
    rosrun("echo error: no map on /map within 30 s >&2; exit 1")
    with pytest.raises(LaunchError, match="map_saver: error: no map on /map within 30 s"):
        mapping.save_map(tmp_path, None)
