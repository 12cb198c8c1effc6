import pytest

from run_project.checkout.needs import missing_packages, navigation_nodes, unset_variables

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
