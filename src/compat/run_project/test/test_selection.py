from run_project.selection import left_out

COMPILED = "find_package(catkin REQUIRED COMPONENTS {0})\nadd_executable(x x.cpp)\n"


def package(folder, name, cmake, **files):
    (folder / name).mkdir()
    (folder / name / "CMakeLists.txt").write_text(cmake)
    for file, text in files.items():
        (folder / name / f"{file}.xacro").write_text(text)
    return {name: folder / name}


def choose(folders, stand_ins=(), there=("roscpp",)):
    return left_out(folders, set(stand_ins), there.__contains__)


def test_the_authors_own_packages_are_built(tmp_path):
    assert choose(package(tmp_path, "pick_objects", COMPILED.format("roscpp"))) == {}


def test_compiled_packages_of_that_time_are_left_out(tmp_path):
    assert (
        "do not build" in choose(package(tmp_path, "kobuki_node", COMPILED.format("roscpp")))["kobuki_node"]
    )


def test_a_launch_package_wins_over_ours_and_a_compiled_one_does_not(tmp_path):
    folders = package(tmp_path, "turtlebot_gazebo", "find_package(catkin REQUIRED)\n")
    folders.update(package(tmp_path, "gmapping", COMPILED.format("roscpp")))
    assert sorted(choose(folders, stand_ins=("turtlebot_gazebo", "gmapping"))) == ["gmapping"]


def test_what_needs_a_package_that_is_not_there_is_left_out_with_its_users(tmp_path):
    folders = package(tmp_path, "low", COMPILED.format("roscpp capabilities"))
    folders.update(package(tmp_path, "high", COMPILED.format("low")))
    reasons = choose(folders)
    assert sorted(reasons) == ["high", "low"]
    assert "needs capabilities" in reasons["low"]


def test_a_commented_dependency_is_none(tmp_path):
    assert choose(package(tmp_path, "a", COMPILED.format("roscpp\n# capabilities\n"))) == {}


def test_a_robot_that_needs_parts_that_are_not_there_is_replaced_by_ours(tmp_path):
    folders = package(tmp_path, "turtlebot_description", "", robot="$(find kobuki_description)/urdf")
    reasons = choose(folders, stand_ins=("turtlebot_description",))
    assert "kobuki_description" in reasons["turtlebot_description"]
    assert choose(folders) == {}
