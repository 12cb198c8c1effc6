import math
import os
import subprocess
import sys
from argparse import ArgumentTypeError
from dataclasses import replace
from pathlib import Path

import pytest

from evaluation.options import ROOT, GraphOptions
from headless_mission.inputs import read_home
from home_service import commands
from home_service.cli import GRAPH_COMMANDS, main
from home_service.commands.test_navigation import goal_list
from sim_bridge import ROBOTS
from supervision.cli import parse
from supervision.view_options import speed_factor


@pytest.fixture(autouse=True)
def without_preloaded_processes(monkeypatch):
    """Commands of these tests start no nodes; each would leave a process that compiles for some seconds."""
    monkeypatch.setattr("home_service.cli.preload_nodes", lambda: None)


def test_the_nodes_of_all_commands_with_a_graph_are_imported_early():
    starting = {
        name for name in commands.FOLDER.names() if issubclass(commands.FOLDER.find(name), GraphOptions)
    }
    assert starting == GRAPH_COMMANDS


def test_help_imports_no_nodes(monkeypatch):
    monkeypatch.setattr("home_service.cli.preload_nodes", lambda: pytest.fail("was called"))
    with pytest.raises(SystemExit):
        main(["home_service", "--seed", "1", "--help"])


def test_goals_are_read_from_a_line():
    assert goal_list("1 2 0.5; -3 4e-1 0;") == [[1.0, 2.0, 0.5], [-3.0, 0.4, 0.0]]


@pytest.mark.parametrize("text", ["1 2", "1 2 three", ";", "1 2 3 4"])
def test_malformed_goals_are_refused(text):
    with pytest.raises(ArgumentTypeError):
        goal_list(text)


@pytest.mark.parametrize("text", ["-1", "fast", "nan", "1e9"])
def test_an_invalid_speed_is_refused(text):
    with pytest.raises(ArgumentTypeError):
        speed_factor(text)


@pytest.mark.parametrize(
    "command", ["launch", "test_navigation", "pick_objects", "add_marker", "home_service"]
)
def test_every_command_has_a_help_text(command, capsys):
    with pytest.raises(SystemExit) as stop:
        parse([command, "--help"], commands.FOLDER)
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
    ],
)
def test_interactive_commands_have_no_default_time_out(arguments, expected):
    assert parse(arguments, commands.FOLDER).time_limit == expected


@pytest.mark.parametrize(
    "arguments, speed",
    [
        (["test_navigation"], 1.0),
        (["test_navigation", "--speed", "0"], 0.0),
        (["test_navigation", "--goals", "1 2 3"], 0.0),
        (["test_navigation", "--goals", "1 2 3", "--web"], 1.0),
        (["launch"], 1.0),
        (["home_service"], 0.0),
        (["home_service", "--serve"], 1.0),
        (["test_slam"], 1.0),
        (["test_slam", "--drive", "auto"], 0.0),
    ],
)
def test_a_run_that_waits_for_a_person_is_at_real_time_by_default(arguments, speed):
    assert parse(arguments, commands.FOLDER).effective_speed == speed


def test_a_headless_run_is_limited_by_simulated_time():
    assert parse(["rehearse"], commands.FOLDER).timeout == 600.0


@pytest.mark.parametrize("option", ["world", "map", "zones"])
def test_a_missing_file_is_named_and_nothing_is_started(option, tmp_path, capsys):
    missing = tmp_path / "missing.file"
    code = main(["home_service", f"--{option}", str(missing), "--output", str(tmp_path / "runs")])
    assert code == 2
    assert str(missing) in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["home_service", "rehearse", "test_navigation"])
def test_an_unknown_planner_is_named_and_nothing_is_started(command, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    goals = ["--goals", "1 0 0"] if command == "test_navigation" else []
    assert main([command, *goals, "--planner", "MppiPlannerROS"]) == 2
    message = capsys.readouterr().err
    assert "no local planner 'MppiPlannerROS' (did you mean \"move_base_lite/MppiPlannerROS\"?)" in message
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", commands.FOLDER.names())
def test_an_unknown_option_is_reported_with_the_name_of_the_script(command, capsys):
    needed = {
        "compare": ["a", "b"],
        "new_plugin": ["mine", "local_planner"],
        "replay": ["bag"],
        "report": ["run"],
        "reproduce": ["run"],
    }.get(command, [])
    with pytest.raises(SystemExit) as stop:
        main([command, *needed, "--nonsense"])
    assert stop.value.code == 2
    message = capsys.readouterr().err
    assert message.startswith(f"usage: {command}.sh ")
    assert message.endswith(f"{command}.sh: error: unrecognized arguments: --nonsense\n")


def test_every_command_has_a_class_with_a_summary_and_a_run_method(capsys):
    with pytest.raises(SystemExit) as stop:
        parse(["--help"], commands.FOLDER)
    assert stop.value.code == 0
    text = capsys.readouterr().out
    for name in commands.FOLDER.names():
        assert callable(commands.FOLDER.find(name).run)
        assert f"  {name} " in text


def test_a_goal_outside_the_map_is_refused_before_anything_is_started(capsys):
    assert main(["test_navigation", "--goals", "1 0 0; 90 0 0"]) == 2
    assert "error: --goals: goal 2 (90, 0) lies outside " in capsys.readouterr().err


def test_a_zone_in_a_wall_or_outside_the_map_is_refused_before_anything_is_started(tmp_path, capsys):
    zones = tmp_path / "zones.yaml"
    zones.write_text("pickup: {x: 2.0, y: 3.0, yaw: 0.0}\ndropoff: {x: 40.0, y: 3.0, yaw: 0.0}\n")
    assert main(["home_service", "--zones", str(zones)]) == 2
    assert f"error: {zones}: place dropoff (40, 3) lies outside the map" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["home_service", "rehearse", "test_navigation", "follow", "add_marker"])
def test_another_world_needs_its_map(command, tmp_path, capsys):
    world = tmp_path / "my.world"
    world.write_bytes((ROOT / "map/home.world").read_bytes())
    assert main([command, "--world", str(world)]) == 2
    assert capsys.readouterr().err == (
        f"error: {world}: no map given, and map/home.yaml is that of map/home.world;\n"
        f"  ./scripts/map_home.sh --world {world} --save {tmp_path}/my\n"
        f"makes one for --map {tmp_path}/my.yaml\n"
    )


def test_the_map_of_the_home_may_be_given_for_another_world(tmp_path):
    world = tmp_path / "my.world"
    world.write_bytes((ROOT / "map/home.world").read_bytes())
    for given in (
        ["--map", str(ROOT / "map/home.yaml"), "--world", str(world)],
        ["--world", "map/home.world"],
    ):
        options = parse(["test_navigation", *given], commands.FOLDER)
        assert read_home(replace(options, world=Path(ROOT / options.world))).grid is not None


def test_a_robot_may_be_given_by_a_relative_path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bot.urdf").write_text(ROBOTS["turtlebot_lidar"].description())
    for command in ("launch", "map_home", "home_service"):
        options = parse([command, "--robot", "bot.urdf"], commands.FOLDER)
        assert options.robot == options.launch("any.launch").arguments["robot"] == str(tmp_path / "bot.urdf")
    assert parse(["launch", "--robot", "jackal"], commands.FOLDER).robot == "jackal"


@pytest.mark.parametrize(
    ("change", "given"),
    [
        (("base_footprint</robotBaseFrame>", "base_link</robotBaseFrame>"), "odom -> base_link"),
        (("odom</odometryFrame>", "world</odometryFrame>"), "world -> base_footprint"),
        (("<publishTf>1</publishTf>", "<publishTf>0</publishTf>"), "no transform"),
    ],
)
@pytest.mark.parametrize("command", ["home_service", "test_navigation", "map_home", "test_slam"])
def test_a_robot_with_other_frames_than_navigation_expects_is_refused(
    command, change, given, tmp_path, capsys
):
    robot = tmp_path / "bot.urdf"
    frames = "<robotBaseFrame>base_footprint</robotBaseFrame><odometryFrame>odom</odometryFrame>"
    text = ROBOTS["jackal"].description()
    assert text.count("</plugin>") > 0
    drive = text.index("</leftJoint>") + len("</leftJoint>")
    text = text[:drive] + frames + "<publishTf>1</publishTf>" + text[drive:]
    robot.write_text(text.replace(*change))
    assert main([command, "--robot", str(robot), "--output", str(tmp_path / "runs")]) == 2
    assert capsys.readouterr().err == (
        f"error: {robot}: its odometry publishes {given}, but localization and navigation expect "
        "odom -> base_footprint; set odometryFrame, robotBaseFrame and publishTf of its drive\n"
    )
    assert not (tmp_path / "runs").exists()


def test_a_run_for_which_too_few_open_files_are_allowed_is_refused_and_leaves_nothing(tmp_path):
    command = [sys.executable, "-m", "home_service", "home_service", "--output", tmp_path / "runs"]
    run = subprocess.run(
        ["bash", "-c", 'ulimit -n 64; exec "$@"', "bash", *command],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    assert run.returncode == 2
    assert run.stderr == ("error: the limit of open files is 64 (ulimit -n), but the nodes need 256\n")
    assert not list(tmp_path.iterdir())


OWN = """
from dataclasses import dataclass
from supervision.command_line import option

@dataclass(frozen=True)
class Greet:
    \"\"\"Greets a person.\"\"\"

    name: str = option("you", "whom")

    def run(self):
        print(f"hello {self.name}")
        return 3

class Plain:
    def run(self):
        return 0

@dataclass
class Idle:
    pass
"""


@pytest.fixture
def own(tmp_path, monkeypatch):
    (tmp_path / "own_commands").mkdir()
    (tmp_path / "own_commands" / "greeting.py").write_text(OWN)
    monkeypatch.syspath_prepend(str(tmp_path))


def test_a_custom_command_is_called_by_its_dotted_name(own, capsys):
    assert main(["own_commands.greeting/Greet", "--name", "robot"]) == 3
    assert capsys.readouterr().out == "hello robot\n"
    with pytest.raises(SystemExit):
        main(["own_commands.greeting/Greet", "--help"])
    assert "Greets a person." in capsys.readouterr().out


@pytest.mark.parametrize(
    "name, why",
    [
        ("own_commands.greeting/Plain", "make it a dataclass"),
        ("own_commands.greeting/Idle", "is no command"),
        ("own_commands.greeting/Absent", "Absent"),
        ("no_such_package.module/Greet", "no_such_package"),
        ("greeting/Greet", "my_package.my_module/MyCommand"),
    ],
)
def test_a_dotted_name_that_is_no_command_is_refused(own, name, why, capsys):
    assert main([name]) == 2
    assert why in capsys.readouterr().err
