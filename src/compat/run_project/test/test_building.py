import os
import subprocess
from pathlib import Path

import pytest

from run_project.checkout.layout import read_checkout
from run_project.checkout.placement import Placement
from run_project.checkout.substitutes import complete_package
from run_project.preparation import building
from run_project.preparation.build_stamp import BuildStamp
from run_project.preparation.building import (
    FRESH_CLONE,
    Workspace,
    broken_configurations,
    build,
    copy_checkout,
    environment,
)
from run_project.stand_ins import PACKAGE_FOLDER

OUTPUT = """
CMake Error at /usr/share/cmake-3.25/Modules/FindPackageHandleStandardArgs.cmake:230 (message):
  Could NOT find Protobuf (missing: Protobuf_LIBRARIES)
Call Stack (most recent call first):
  /usr/share/cmake-3.25/Modules/FindProtobuf.cmake:650 (FIND_PACKAGE_HANDLE_STANDARD_ARGS)
  maps/CMakeLists.txt:12 (find_package)


CMake Error at worlds/CMakeLists.txt:7 (find_package):
  By not providing "Findgazebo.cmake" in CMAKE_MODULE_PATH ...

  Could not find a package configuration file provided by "gazebo" with any
  of the following names:

-- Configuring incomplete, errors occurred!
"""


def test_programs_are_made_executable_in_the_copy(tmp_path):
    files = {
        "pick/package.xml": "<package><name>pick</name></package>",
        "pick/scripts/home.py": "#!/usr/bin/env python\n",
        "pick/scripts/drive": "#!/bin/sh\n",
        "pick/scripts/library.py": "import math\n",
        "home_service.sh": "rosrun pick home.py\n",
        "docker/build": "#!/bin/sh\n",
        "build/pick.make": "all:\n",
    }
    for name, text in files.items():
        (tmp_path / "repo" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "repo" / name).write_text(text)
    checkout = read_checkout(tmp_path / "repo")
    workspace = copy_checkout(checkout, Placement(Path("src"), Path(), Path("src"), {}), tmp_path / "work")
    runs = [name for name in files if os.access(workspace.checkout / name, os.X_OK)]
    assert runs == ["pick/scripts/home.py", "pick/scripts/drive", "home_service.sh", "docker/build"]
    assert not (workspace.checkout / "build/pick.make").exists()


def test_packages_that_cannot_be_configured_are_listed_with_the_reason(tmp_path):
    packages = {name: tmp_path / "src" / name for name in ("maps", "worlds", "pick")}
    broken = broken_configurations(
        Workspace(tmp_path, tmp_path / "src", packages, tmp_path / "placeholders"), OUTPUT
    )
    assert broken == {
        "maps": "Could NOT find Protobuf (missing: Protobuf_LIBRARIES)",
        "worlds": "needs gazebo, which is not installed",
    }


ABSENT = """CMake Error at ball_chaser/CMakeLists.txt:215 (add_dependencies):
  The dependency target "simple_arm_generate_messages_cpp" of target
  "drive_bot" does not exist.
-- Generating done
CMake Generate step failed.  Build files cannot be regenerated correctly.
"""


def test_a_dependency_on_message_targets_that_do_not_exist_is_ignored(tmp_path, monkeypatch):
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").touch()
    workspace = Workspace(tmp_path, tmp_path / "src", {}, tmp_path / "placeholders")
    outputs = [ABSENT, "[100%] Built target drive_bot"]
    monkeypatch.setattr(building, "_catkin_make", lambda workspace, log: outputs.pop(0))
    build(workspace, tmp_path / "build.log", print)
    assert workspace.absent_targets == {"simple_arm_generate_messages_cpp"}
    assert (outputs, workspace.unbuilt) == ([], set())


@pytest.fixture
def builds(tmp_path, monkeypatch):
    """A function that copies and builds a project, and returns whether catkin_make was called."""
    (tmp_path / "repo" / "pick").mkdir(parents=True)
    (tmp_path / "repo" / "pick" / "package.xml").write_text("<package><name>pick</name></package>")
    (tmp_path / "repo" / "pick" / "go.py").write_text("#!/usr/bin/env python\nprint 'go'\n")
    outputs = []

    def catkin_make(workspace, _):
        (workspace.folder / "devel" / "setup.bash").touch()
        calls.append(workspace)
        return outputs[-1] if outputs else ""

    def run(output=""):
        outputs.append(output)
        calls.clear()
        placement = Placement(Path("src"), Path(), Path("src"), {})
        workspace = copy_checkout(read_checkout(tmp_path / "repo"), placement, tmp_path / "work")
        build(workspace, tmp_path / "build.log", lambda _: None)
        assert "print('go')" in (workspace.checkout / "pick/go.py").read_text()
        return bool(calls)

    calls = []
    monkeypatch.setattr(building, "_catkin_make", catkin_make)
    return run


def test_a_project_is_not_built_again_before_something_changes(builds, tmp_path):
    assert [builds(), builds()] == [True, False]
    (tmp_path / "repo" / "pick" / "new.py").write_text("")
    assert [builds(), builds()] == [True, False]
    (tmp_path / "work" / "devel" / "setup.bash").unlink()
    assert builds()


def test_a_project_is_built_again_after_a_build_that_was_not_complete(builds):
    assert [builds("make: *** [pick] Error 1"), builds("make: *** [pick] Error 1")] == [True, True]
    assert [builds(), builds()] == [True, False]


def test_a_mark_that_is_made_again_in_each_copy_is_no_change(tmp_path):
    mark = tmp_path / "tree" / "turtlebot" / "CATKIN_IGNORE"
    mark.parent.mkdir(parents=True)
    mark.touch()
    BuildStamp(tmp_path / "built", tmp_path / "tree", ()).write()
    os.utime(mark, (1, 1))
    assert BuildStamp(tmp_path / "built", tmp_path / "tree", ()).is_current
    mark.write_text("later")
    assert not BuildStamp(tmp_path / "built", tmp_path / "tree", ()).is_current


def test_turtlebot3_model_has_a_default(tmp_path, monkeypatch):
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").touch()
    workspace = Workspace(tmp_path, tmp_path / "src", {}, tmp_path / "placeholders", ())
    monkeypatch.delenv("TURTLEBOT3_MODEL", raising=False)
    assert environment(workspace)["TURTLEBOT3_MODEL"] == "burger"
    monkeypatch.setenv("TURTLEBOT3_MODEL", "waffle")
    assert environment(workspace)["TURTLEBOT3_MODEL"] == "waffle"


def test_files_that_the_user_names_are_kept_but_not_defaults_of_this_workspace(tmp_path, monkeypatch):
    workspace = Workspace(tmp_path, tmp_path, {}, tmp_path)
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").write_text(
        ": ${TURTLEBOT_GAZEBO_MAP_FILE:=/theirs.yaml}; export TURTLEBOT_GAZEBO_MAP_FILE"
    )
    monkeypatch.setenv("TURTLEBOT_GAZEBO_WORLD_FILE", "/home/me/u.world")
    monkeypatch.setenv(
        "TURTLEBOT_GAZEBO_MAP_FILE", str(PACKAGE_FOLDER.parent / "turtlebot_gazebo/maps/playground.yaml")
    )
    assert environment(workspace)["TURTLEBOT_GAZEBO_WORLD_FILE"] == "/home/me/u.world"
    assert environment(workspace)["TURTLEBOT_GAZEBO_MAP_FILE"] == "/theirs.yaml"


def test_model_folders_are_appended_to_the_gazebo_model_path_of_the_project(tmp_path):
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").write_text("export GAZEBO_MODEL_PATH=/theirs")
    models = (tmp_path / "src/models", tmp_path / "src/world")
    workspace = Workspace(tmp_path, tmp_path / "src", {}, tmp_path / "placeholders", models)
    assert environment(workspace)["GAZEBO_MODEL_PATH"] == f"/theirs:{models[0]}:{models[1]}"


def test_a_vendored_package_keeps_its_files_and_gets_those_and_the_programs_of_the_replacing_one(tmp_path):
    files = {
        "theirs/launch/maze.launch": "<launch/>",
        "theirs/launch/world.launch": "<!-- theirs -->",
        "theirs/scripts/drive": "#!/usr/bin/env python2",
        "ours/launch/world.launch": "<!-- ours -->",
        "ours/launch/house.launch": "<launch/>",
        "ours/nodes/drive": "#!/usr/bin/env python3",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
        if text.startswith("#!"):
            (tmp_path / name).chmod(0o755)
    theirs = tmp_path / "theirs"
    complete_package(theirs, tmp_path / "ours", replaces_robots=False)
    assert sorted(file.name for file in (theirs / "launch").iterdir()) == [
        "house.launch",
        "maze.launch",
        "world.launch",
    ]
    assert (theirs / "launch/world.launch").read_text() == "<!-- theirs -->"
    programs = [file for file in theirs.rglob("drive") if os.access(file, os.X_OK)]
    assert [file.read_text() for file in programs] == ["#!/usr/bin/env python3"]


@pytest.mark.skipif(not Path("/usr/include/eigen3").exists(), reason="Eigen is not installed")
def test_headers_of_eigen_are_found_without_the_package_that_passed_them_on(tmp_path):
    source, build = tmp_path / "source", tmp_path / "build"
    source.mkdir()
    (source / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.0.2)\nproject(eye CXX)\nadd_library(eye OBJECT eye.cpp)\n"
    )
    (source / "eye.cpp").write_text(
        "#include <Eigen/Core>\nint rows() { return Eigen::Matrix2d().rows(); }\n"
    )
    included = f"-DCMAKE_PROJECT_INCLUDE={FRESH_CLONE}"
    for command in (["cmake", "-S", source, "-B", build, included], ["cmake", "--build", build]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
