import pytest

from run_project.checkout.needs import (
    files_left_to_environment,
    missing_packages,
    navigation_nodes,
    unset_variables,
)
from run_project.stand_ins import PACKAGE_FOLDER

SCRIPT = """#!/bin/bash
# roslaunch old_package x.launch, with $OLD
export WORLD=$(pwd)/home.world
for name in a b; do echo $name; done
xterm -e "cd $CATKIN_WS && roslaunch my_robot world.launch world:=${WORLD}" &
xterm -e 'source $HOME/devel/setup.bash; rosrun tools --debug go.py' &
roslaunch ./here.launch; roslaunch here.launch
echo ${OPTION:-none} "$1" $TURTLEBOT_MAP
"""


def test_packages_that_a_script_starts_something_from_are_found():
    assert missing_packages(SCRIPT, lambda name: False) == ["my_robot", "tools"]
    assert missing_packages(SCRIPT, {"my_robot"}.__contains__) == ["tools"]


def test_variables_that_nothing_sets_are_found():
    assert unset_variables(SCRIPT, {"HOME"}) == ["CATKIN_WS", "TURTLEBOT_MAP"]


@pytest.mark.parametrize("line", ["read -p 'place? ' x; echo $x", "local x=1; echo ${x}", "x+=(1); echo $x"])
def test_what_a_script_sets_itself_is_not_missing(line):
    assert unset_variables(line, ()) == []


@pytest.mark.parametrize(
    ("text", "nodes"),
    [
        ("rosrun my_robot go.py", []),
        ('<node type="move_base" pkg="move_base" name="planner"/>', ["planner"]),
        ("<node name='loc' pkg='amcl'\n type='amcl'/> <node pkg='x' name='amcl'/>", ["loc"]),
        ("roslaunch turtlebot_gazebo amcl_demo.launch", ["amcl", "move_base"]),
        ("# roslaunch turtlebot_navigation amcl_demo.launch", []),
    ],
)
def test_the_nodes_of_navigation_have_the_names_of_the_project(text, nodes):
    assert navigation_nodes([text]) == nodes


WORLD, MAP = (
    "roslaunch turtlebot_gazebo turtlebot_world.launch",
    "roslaunch turtlebot_gazebo amcl_demo.launch",
)
OWN = {"world_file": ["maps/u.world"], "map_file": ["maps/u.yaml"]}
NONE_OWN = {"world_file": [], "map_file": []}
VENDORED = ["turtlebot_gazebo/launch/turtlebot_world.launch"]


def test_worlds_and_maps_that_the_environment_may_have_named_are_found():
    world, map_file = files_left_to_environment(f'xterm -e "{WORLD}" &\n{MAP}', OWN, (), {})
    assert "maps/u.world" in world
    assert "set TURTLEBOT_GAZEBO_WORLD_FILE" in world
    assert "maps/u.yaml:" in map_file
    assert "set TURTLEBOT_GAZEBO_MAP_FILE" in map_file


@pytest.mark.parametrize(
    ("script", "own", "launch_files"),
    [
        (f"# {WORLD}", OWN, ()),
        (f"{WORLD} world_file:=$(pwd)/u.world; {MAP} gui:=true map_file:=u.yaml", OWN, ()),
        (f"export TURTLEBOT_GAZEBO_WORLD_FILE=u.world; {WORLD}", OWN, ()),
        (WORLD, OWN, VENDORED),
        (f"{WORLD}; {MAP}", NONE_OWN, ()),
        ("roslaunch my_gazebo turtlebot_world.launch", OWN, ()),
    ],
)
def test_a_script_that_names_its_files_or_has_none_is_not_asked_for_them(script, own, launch_files):
    assert files_left_to_environment(script, own, launch_files, {}) == []


def test_the_environment_names_them():
    environment = {"TURTLEBOT_GAZEBO_WORLD_FILE": "/home/me/u.world"}
    assert files_left_to_environment(WORLD, OWN, (), environment) == []


def test_the_default_of_this_workspace_is_not_the_authors():
    default = PACKAGE_FOLDER.parent / "turtlebot_gazebo/worlds/playground.world"
    assert default.is_file()
    environment = {"TURTLEBOT_GAZEBO_WORLD_FILE": str(default)}
    assert len(files_left_to_environment(WORLD, OWN, (), environment)) == 1
