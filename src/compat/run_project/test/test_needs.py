import pytest

from run_project.checkout.needs import (
    files_left_to_environment,
    missing_packages,
    navigation_nodes,
    unset_variables,
)

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
FILES = ("maps/u.yaml", "maps/u.pgm", "maps/tuning.yaml", "maps/u.world")


def test_worlds_and_maps_that_the_environment_may_have_named_are_found():
    world, map_file = files_left_to_environment(f'xterm -e "{WORLD}" &\n{MAP}', FILES, ())
    assert "maps/u.world" in world
    assert "set TURTLEBOT_GAZEBO_WORLD_FILE" in world
    assert "maps/u.yaml:" in map_file
    assert "set TURTLEBOT_GAZEBO_MAP_FILE" in map_file


@pytest.mark.parametrize(
    ("script", "files"),
    [
        (f"# {WORLD}", FILES),
        (f"{WORLD} world_file:=$(pwd)/u.world; {MAP} gui:=true map_file:=u.yaml", FILES),
        (f"export TURTLEBOT_GAZEBO_WORLD_FILE=u.world; {WORLD}", FILES),
        (WORLD, (*FILES, "turtlebot_gazebo/launch/turtlebot_world.launch")),
        (f"{WORLD}; {MAP}", ("maps/tuning.yaml",)),
        ("roslaunch my_gazebo turtlebot_world.launch", FILES),
    ],
)
def test_a_script_that_names_its_files_or_has_none_is_not_asked_for_them(script, files):
    assert files_left_to_environment(script, files, ()) == []


def test_the_environment_names_them():
    assert files_left_to_environment(WORLD, FILES, ("TURTLEBOT_GAZEBO_WORLD_FILE",)) == []
