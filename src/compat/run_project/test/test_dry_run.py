from run_project.checkout.dry_run import recorded_calls

SCRIPT = """#!/bin/sh
catkin_dir=/home/workspace/catkin_ws
catkin_src=$catkin_dir/src
cd $catkin_dir/devel
source $catkin_dir/devel/setup.bash
export TURTLEBOT_GAZEBO_MAP_FILE="${catkin_src}/map/$(basename /a/my_map.yaml)"
xterm -e "roslaunch turtlebot_gazebo turtlebot_world.launch world_file:=$catkin_src/World/my_world.world" &
sleep 500
rm -rf $catkin_dir/build
touch {touched}
"""


def dry_run(tmp_path, text):
    script = tmp_path / "home_service.sh"
    script.write_text(text)
    return recorded_calls(script, tmp_path, ["--fast"]).splitlines()


def test_paths_composed_from_variables_are_recorded(tmp_path):
    lines = dry_run(tmp_path, SCRIPT.replace("{touched}", str(tmp_path / "touched")))
    assert "/home/workspace/catkin_ws/devel" in lines
    assert "/home/workspace/catkin_ws/devel/setup.bash" in lines
    world = "world_file:=/home/workspace/catkin_ws/src/World/my_world.world"
    assert any(line.endswith(world) for line in lines)
    assert "TURTLEBOT_GAZEBO_MAP_FILE=/home/workspace/catkin_ws/src/map/my_map.yaml" in lines


def test_called_programs_are_not_executed(tmp_path):
    lines = dry_run(tmp_path, SCRIPT.replace("{touched}", str(tmp_path / "touched")))
    assert str(tmp_path / "touched") in lines
    assert not (tmp_path / "touched").exists()
    assert "dry-run-" not in "".join(lines)


def test_a_script_that_loops_forever_is_stopped(tmp_path, monkeypatch):
    monkeypatch.setattr("run_project.checkout.dry_run.DRY_RUN_SECONDS", 0.5)
    assert "--once" in dry_run(tmp_path, "rosrun a b --once\nwhile true; do :; done\n")


def test_the_script_gets_its_arguments(tmp_path):
    assert "--fast" in dry_run(tmp_path, 'roslaunch a b "$1"\n')


def test_a_script_in_another_language_is_not_run(tmp_path):
    assert dry_run(tmp_path, "#!/usr/bin/env python3\nprint(1)\n") == []
