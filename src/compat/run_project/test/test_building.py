from run_project.building import Workspace, broken_configurations

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
