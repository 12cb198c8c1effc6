import pytest

from run_project.preparation.selection import select_packages

COMPILED = "find_package(catkin REQUIRED COMPONENTS {0})\nadd_executable(x x.cpp)\n"


def package(folder, name, cmake, **files):
    (folder / name).mkdir()
    (folder / name / "CMakeLists.txt").write_text(cmake)
    for file, text in files.items():
        (folder / name / f"{file}.xacro").write_text(text)
    return {name: folder / name}


def stand_in(folder, name, *parts):
    for part in parts:
        (folder / "ours" / name / part).mkdir(parents=True)
    return {name: folder / "ours" / name}


def choose(folders, stand_ins=None, there=("roscpp",)):
    return select_packages(folders, stand_ins or {}, there.__contains__)


def test_the_authors_own_packages_are_built(tmp_path):
    selection = choose(package(tmp_path, "pick_objects", COMPILED.format("roscpp")))
    assert (selection.replaced, selection.unbuilt, selection.absent) == ({}, {}, {})


def test_vendored_compiled_packages_are_not_built(tmp_path):
    selection = choose(package(tmp_path, "kobuki_node", COMPILED.format("roscpp capabilities")))
    assert "do not build" in selection.unbuilt["kobuki_node"]
    assert selection.absent == {}


def test_launch_packages_of_the_project_take_precedence_but_vendored_programs_are_replaced(tmp_path):
    folders = package(tmp_path, "turtlebot_gazebo", "find_package(catkin REQUIRED)\n")
    folders.update(package(tmp_path, "gmapping", COMPILED.format("roscpp")))
    folders.update(package(tmp_path, "turtlebot_navigation", COMPILED.format("roscpp")))
    ours = {
        **stand_in(tmp_path, "turtlebot_gazebo", "launch"),
        **stand_in(tmp_path, "turtlebot_navigation", "launch"),
        **stand_in(tmp_path, "gmapping", "nodes", "launch"),
    }
    selection = choose(folders, ours)
    assert (sorted(selection.completed), selection.replaced) == (["gmapping"], {})
    assert sorted(selection.unbuilt) == ["turtlebot_navigation"]


@pytest.mark.parametrize("name", ["turtlebot_waiter", "kobuki_dance", "create_map", "explore"])
def test_an_own_package_is_built_whatever_its_name_begins_with(tmp_path, name):
    assert choose(package(tmp_path, name, COMPILED.format("roscpp"))).unbuilt == {}


def test_a_dependency_that_is_not_installed_is_reported_with_its_users(tmp_path):
    folders = package(tmp_path, "low", COMPILED.format("roscpp capabilities"))
    folders.update(package(tmp_path, "high", COMPILED.format("low")))
    assert choose(folders).absent == {"capabilities": ["low"]}


def test_commented_dependencies_are_ignored(tmp_path):
    assert choose(package(tmp_path, "a", COMPILED.format("roscpp\n# capabilities\n"))).absent == {}


def test_a_robot_description_with_missing_parts_is_replaced(tmp_path):
    folders = package(tmp_path, "turtlebot_description", "", robot="$(find kobuki_description)/urdf")
    ours = stand_in(tmp_path, "turtlebot_description", "robots")
    assert "kobuki_description" in choose(folders, ours).replaced["turtlebot_description"]
    assert choose(folders).replaced == {}
