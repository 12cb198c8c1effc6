import pytest

from gazebo_ros.gzserver import world_argument
from gazebo_ros.spawn_options import parse

ROBOT = ["-urdf", "-param", "robot_description", "-model", "my_robot"]


@pytest.mark.parametrize(
    "line",
    [
        "-u -e ode home.world",  # as empty_world.launch of Kinetic with paused:=true
        "-r --verbose --lockstep home.world",
        "--seed 7 --iters 100 -o fast --record_path /tmp/log home.world",
        "-s libgazebo_ros_api_plugin.so -g libgazebo_ros_paths_plugin.so home.world __name:=gazebo",
        "home.world -u --pause",
    ],
)
def test_the_world_is_found_among_gazebos_options(line):
    assert world_argument(line.split()) == "home.world"


def test_options_alone_name_no_world():
    assert world_argument(["-e", "ode", "--verbose", "-u"]) is None


def test_an_option_is_not_recognized_by_its_prefix():
    options, unknown = parse([*ROBOT, "-yaw", "1.57", "-xyz", "1", "-bond", "-Y", "0.5"], "/")
    assert (options.x, options.y, options.Y, options.b) == (0.0, 0.0, 0.5, False)
    assert unknown == ["-yaw", "1.57", "-xyz", "1", "-bond"]


def test_a_value_may_look_like_an_option():
    options, unknown = parse([*ROBOT, "-x", "-1e-3", "-reference_frame", "-world", "-y", "-2"], "/")
    assert (options.x, options.y, options.reference_frame, unknown) == (-1e-3, -2.0, "-world", [])


def test_a_trailing_option_without_a_value_is_ignored():
    assert parse([*ROBOT, "-z"], "/")[1] == ["-z"]
    assert parse([*ROBOT, "-J", "hinge"], "/")[1] == ["-J", "hinge"]


def test_older_option_names_are_accepted():
    options, unknown = parse(["-gazebo", "-file", "a.sdf", "-model", "a", "-namespace", "one"], "/")
    assert (options.sdf, options.robot_namespace, unknown) == (True, "one", [])


def test_a_robot_has_the_namespace_of_the_command_and_the_last_of_two_values():
    options, _ = parse([*ROBOT, "-x", "1", "-x", "2", "-J", "wheel", "-0.5"], "/tb3_0/")
    assert (options.robot_namespace, options.x, options.J) == ("/tb3_0/", 2.0, [["wheel", "-0.5"]])


def test_two_sources_or_a_missing_name_are_rejected(capsys):
    for words in ([*ROBOT, "-file", "a.urdf"], ["-urdf", "-param", "robot_description"]):
        with pytest.raises(SystemExit):
            parse(words, "/")
