import time
from types import SimpleNamespace

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


@pytest.fixture()
def run(tmp_path):
    return SimpleNamespace(folder=tmp_path, end_of_graph=None)


def test_a_map_saver_that_does_not_end_is_an_error_of_one_line(rosrun, run, monkeypatch):
    rosrun("exec sleep 60")
    monkeypatch.setattr(mapping, "SAVE_SECONDS", 0.2)
    with pytest.raises(LaunchError, match="map_saver: did not exit within 0.2 s$"):
        mapping.save_map(run, None)
    monkeypatch.setattr(mapping, "SAVE_SECONDS", 2.0)
    rosrun("echo Waiting for the map; echo waiting for a map on /map >&2; exec sleep 60")
    with pytest.raises(LaunchError, match="map_saver: .*; last line of its log: waiting for a map on /map$"):
        mapping.save_map(run, None)


def test_a_map_saver_without_a_map_is_reported(rosrun, run):
    rosrun("echo error: no map on /map within 30 s >&2; exit 1")
    with pytest.raises(LaunchError, match="map_saver: error: no map on /map within 30 s"):
        mapping.save_map(run, None)


def test_a_map_saver_ends_with_the_graph(rosrun, run):
    rosrun("exec sleep 60")
    run.end_of_graph = "roslaunch was ended by SIGKILL"
    started = time.monotonic()
    with pytest.raises(LaunchError, match="^roslaunch was ended by SIGKILL$"):
        mapping.save_map(run, None)
    with pytest.raises(LaunchError, match="^sim_bridge: died; roslaunch was ended by SIGKILL$"):
        mapping.save_map(run, None, "sim_bridge: died")
    assert time.monotonic() - started < 30.0


def test_an_earlier_failure_is_reported_first_and_once(rosrun, run):
    rosrun("echo error: no map >&2; exit 1")
    with pytest.raises(LaunchError, match="^explore: nothing is free; map_saver: error: no map$"):
        mapping.save_map(run, None, "explore: nothing is free")
    rosrun("exec sleep 60")
    run.end_of_graph = "sim_bridge: died"
    with pytest.raises(LaunchError, match="^sim_bridge: died$"):
        mapping.save_map(run, None, "sim_bridge: died")


def test_a_map_is_saved_whatever_failed_before(rosrun, run):
    rosrun("exit 0")
    assert mapping.save_map(run, None, "not done within 1 s") == run.folder / "map.yaml"
