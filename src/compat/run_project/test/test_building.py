from run_project.preparing.building import Workspace, broken_configurations, environment

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


def test_packages_that_cannot_be_configured_are_told_with_the_reason(tmp_path):
    packages = {name: tmp_path / "src" / name for name in ("maps", "worlds", "pick")}
    broken = broken_configurations(
        Workspace(tmp_path, tmp_path / "src", packages, tmp_path / "pretended"), OUTPUT
    )
    assert broken == {
        "maps": "Could NOT find Protobuf (missing: Protobuf_LIBRARIES)",
        "worlds": "needs gazebo, which is not there",
    }


def test_the_model_of_a_turtlebot3_is_assumed_where_nobody_says_it(tmp_path, monkeypatch):
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").touch()
    workspace = Workspace(tmp_path, tmp_path / "src", {}, tmp_path / "pretended", ())
    monkeypatch.delenv("TURTLEBOT3_MODEL", raising=False)
    assert environment(workspace)["TURTLEBOT3_MODEL"] == "burger"
    monkeypatch.setenv("TURTLEBOT3_MODEL", "waffle")
    assert environment(workspace)["TURTLEBOT3_MODEL"] == "waffle"


def test_models_are_found_where_they_lie_after_the_folders_that_the_project_names(tmp_path):
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").write_text("export GAZEBO_MODEL_PATH=/theirs")
    models = (tmp_path / "src/models", tmp_path / "src/world")
    workspace = Workspace(tmp_path, tmp_path / "src", {}, tmp_path / "pretended", models)
    assert environment(workspace)["GAZEBO_MODEL_PATH"] == f"/theirs:{models[0]}:{models[1]}"
