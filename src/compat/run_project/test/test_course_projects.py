"""Course projects are recognized by their launch files, and judged by their checks."""

import math
from pathlib import Path

import numpy as np

from planar import Pose2
from run_project.course.checks import CheckResults, camera_pose
from run_project.course.launch_plan import CourseProject, ProjectLaunchPlan, find_launch_plan

WORLD = '<launch><include file="$(find gazebo_ros)/launch/empty_world.launch"/></launch>'
CHASER = '<launch><node name="p" type="process_image" pkg="ball_chaser"/></launch>'
AMCL = '<launch><node name="amcl" pkg="amcl" type="amcl"/></launch>'
RTABMAP = '<launch><node name="rtabmap" pkg="rtabmap_ros" type="rtabmap"/></launch>'
PACKAGES = {"my_robot": Path("my_robot"), "ball_chaser": Path("ball_chaser")}
CHASE_FILES = {
    "my_robot/launch/world.launch": WORLD,
    "ball_chaser/launch/ball_chaser.launch": CHASER,
}


def planned(more=(), wanted=None):
    return find_launch_plan(PACKAGES, {**CHASE_FILES, **dict(more)}, wanted)


def test_a_robot_with_a_world_and_process_image_chases_a_ball():
    assert planned() == ProjectLaunchPlan(
        CourseProject.CHASE, ("my_robot world.launch", "ball_chaser ball_chaser.launch")
    )


def test_the_last_project_is_selected_because_each_contains_the_earlier_ones():
    amcl = {"my_robot/launch/amcl.launch": AMCL}
    assert planned(amcl).project is CourseProject.LOCALIZE
    assert planned({**amcl, "my_robot/launch/mapping.launch": RTABMAP}).project is CourseProject.MAP


def test_copies_of_public_packages_do_not_make_a_lesson():
    packages = {**PACKAGES, "turtlebot_navigation": Path("turtlebot_navigation")}
    gmapping = '<launch><node name="g" pkg="gmapping" type="slam_gmapping"/></launch>'
    files = {**CHASE_FILES, "turtlebot_navigation/launch/gmapping_demo.launch": gmapping}
    assert find_launch_plan(packages, files, None).project is CourseProject.CHASE
    assert find_launch_plan(packages, files, "map_my_world").project is CourseProject.MAP


def test_an_earlier_project_can_be_selected_by_name():
    assert planned({"my_robot/launch/amcl.launch": AMCL}, "go_chase_it").project is CourseProject.CHASE
    assert planned(wanted="map_my_world") is None


def test_mapping_starts_without_a_database():
    files = {"my_robot/launch/localization.launch": RTABMAP, "my_robot/launch/rtab.launch": RTABMAP}
    assert planned(files).launches == ("my_robot world.launch", "my_robot rtab.launch")


def test_a_launch_file_that_includes_the_world_is_sufficient():
    files = {"my_robot/launch/amcl.launch": AMCL + '<include file="$(find my_robot)/launch/world.launch"/>'}
    assert planned(files).launches == ("my_robot amcl.launch",)


def test_a_launch_file_with_the_usual_name_may_include_the_nodes():
    included = '<include file="$(find my_robot)/launch/parts/node.launch"/>'
    files = {
        "my_robot/launch/amcl.launch": f"<launch>{included}</launch>",
        "my_robot/launch/parts/node.launch": AMCL,
    }
    assert planned(files).launches == ("my_robot world.launch", "my_robot amcl.launch")
    files["my_robot/launch/all.launch"] = files.pop("my_robot/launch/amcl.launch")
    assert planned(files).launches[1] == "my_robot node.launch"


def test_required_arguments_are_taken_from_the_scripts_of_the_author():
    files = {
        "my_robot/launch/world.launch": WORLD + '<arg name="gui" default="true"/> $(arg gui) $(arg map)',
        "a.sh": "roslaunch my_robot world.launch gui:=false\n",
        "start.sh": 'xterm -e "roslaunch my_robot world.launch map:=kitchen gui:=false" &\n',
    }
    assert planned(files).launches[0] == "my_robot world.launch map:=kitchen gui:=false"
    files["my_robot/launch/world.launch"] = WORLD + '<arg name="map" default="office"/> $(arg map)'
    assert planned(files).launches[0] == "my_robot world.launch"
    files["my_robot/launch/world.launch"] = WORLD + '<arg name="map" doc="which"/>'
    assert planned(files).launches[0] == "my_robot world.launch map:=kitchen gui:=false"
    del files["start.sh"]
    assert planned(files).launches[0] == "my_robot world.launch"


def test_nodes_in_comments_are_ignored():
    assert find_launch_plan(PACKAGES, {"my_robot/launch/a.launch": f"<!-- {AMCL} -->"}, None) is None


def test_the_script_opens_a_window_for_each_launch_file():
    lines = planned().script().splitlines()
    assert lines[1:] == [
        'xterm -e "roslaunch my_robot world.launch" &',
        'xterm -e "roslaunch ball_chaser ball_chaser.launch" &',
        "wait",
    ]


def test_a_course_project_succeeds_if_all_checks_passed():
    results = CheckResults()
    assert not results.verdict().success, "nothing was checked"
    results.add(True, "chased the ball")
    assert results.verdict().success
    assert results.verdict().reason == "1 of 1 checks passed: chased the ball"
    assert not results.verdict("interrupted").success
    results.add(False, "did not stop after the ball was removed")
    assert not results.verdict().success


def test_a_camera_is_placed_by_its_direction_of_view():
    backwards = np.eye(4)
    backwards[:3, :3], backwards[:3, 3] = np.diag([-1.0, -1.0, 1.0]), (0.2, 0.1, 0.3)
    assert camera_pose(backwards, is_optical=False) == Pose2(0.2, 0.1, math.pi)
    optical = np.eye(4)
    optical[:3, :3] = [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]  # z forward, x to the right
    assert camera_pose(optical, is_optical=True).yaw == 0.0
