import sys
import time

import psutil
import pytest

from run_project.ros.processes import waits_for_input
from run_project.stand_ins.terminal import INPUT_VARIABLE, open_window
from run_project.stand_ins.windows import commands_of, returns_at_once, title_of


@pytest.mark.parametrize(
    ("terminal", "arguments", "commands"),
    [
        ("xterm", ["-e", " roslaunch a b.launch "], [["bash", "-c", " roslaunch a b.launch "]]),
        ("xterm", ["-T", "My -e world", "-hold", "-e", "roscore"], [["bash", "-c", "roscore"]]),
        ("xterm", ["-xrm", "XTerm*x: y", "-name", "a", "-e", "rosrun", "a", "b"], [["rosrun", "a", "b"]]),
        ("xterm", ["-hold"], []),
        ("xterm", ["-e", "roslaunch a b map:=~/c ~"], [["bash", "-c", "roslaunch a b map:=$HOME/c ~"]]),
        ("uxterm", ["-e", "roscore"], [["bash", "-c", "roscore"]]),
        ("terminator", ["-T", "a", "-e", "roscore"], [["bash", "-c", "roscore"]]),
        ("terminator", ["--new-tab", "-x", "rosrun", "a", "b"], [["rosrun", "a", "b"]]),
        ("gnome-terminal", ["--", "bash", "-c", "roscore"], [["bash", "-c", "roscore"]]),
        ("gnome-terminal", ["-x", "bash", "-c", "roscore"], [["bash", "-c", "roscore"]]),
        (
            "gnome-terminal",
            ["--tab", "-e", "roscore", "--tab", "--title=x", "--command=rosrun a b"],
            [["bash", "-c", "roscore"], ["bash", "-c", "rosrun a b"]],
        ),
    ],
)
def test_a_terminal_runs_what_its_window_would(terminal, arguments, commands):
    assert commands_of(terminal, arguments) == commands


@pytest.mark.parametrize(
    ("command", "title"),
    [
        (
            ["bash", "-c", " source x.bash; roslaunch turtlebot_gazebo a_world.launch a:=b"],
            "roslaunch-a_world",
        ),
        (["rosrun", "pick_objects", "pick_objects"], "rosrun-pick_objects"),
        (["bash", "-c", "roscore"], "roscore"),
        (["bash", "-c", "source a.bash; cd b && roscore"], "roscore"),
        (["bash", "-c", "source a.bash"], "window"),
        (["bash", "-c", "echo 'unbalanced"], "echo"),
    ],
)
def test_a_window_is_named_after_its_command(command, title):
    assert title_of(command) == title


def test_only_terminals_with_a_server_return_at_once():
    assert returns_at_once("gnome-terminal")
    assert not returns_at_once("xterm")


def test_a_program_gets_its_input_and_waits_for_more(tmp_path, monkeypatch):
    script = tmp_path / "ask"
    script.write_text(f"#!{sys.executable}\nprint('yes or no?', input(), flush=True)\ninput()\n")
    script.chmod(0o755)
    monkeypatch.setenv(INPUT_VARIABLE, "another=no\nask=yes, please")
    window = open_window([str(script)], tmp_path)
    try:
        assert _soon(lambda: "yes or no? yes, please" in (tmp_path / "ask.log").read_text())
        assert _soon(lambda: waits_for_input(psutil.Process(window.pid)))
        assert window.poll() is None
    finally:
        window.kill()
        window.wait()


def _soon(condition, seconds=20.0):
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.02)
    return condition()
