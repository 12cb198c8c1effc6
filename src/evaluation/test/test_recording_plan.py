"""Launch arguments of a recording, whatever the result.json of its run contains."""

import json
import os

import pytest

from evaluation.recording_plan import recording_plan


@pytest.fixture
def run_folder(tmp_path):
    (tmp_path / "bags").mkdir()
    return tmp_path


def arguments_of(run_folder):
    arguments = recording_plan([run_folder / "bags" / "run.bag"]).arguments
    return {name: value for name, value in arguments.items() if name not in ("bags", "stays")}


def test_the_world_and_the_robot_are_those_of_the_run(run_folder):
    world = run_folder / "some.world"
    world.touch()
    (run_folder / "result.json").write_text(json.dumps({"world": str(world), "robot": "turtlebot3_burger"}))
    assert arguments_of(run_folder) == {"world_file": str(world), "robot": "turtlebot3_burger"}


@pytest.mark.parametrize(
    "content",
    [
        "",
        "{",
        "[1]",
        "[" * 100_000,
        '{"world": 3, "robot": [1]}',
        json.dumps({"world": "/nowhere.world", "robot": "nobody"}),
        json.dumps({"world": "x" * 5000, "robot": "x" * 5000}),
        json.dumps({"world": "\0"}),
    ],
)
def test_unusable_results_are_ignored(run_folder, content):
    (run_folder / "result.json").write_text(content)
    assert arguments_of(run_folder) == {}


def test_a_pipe_is_not_waited_for(run_folder):
    os.mkfifo(run_folder / "result.json")
    assert arguments_of(run_folder) == {}
