"""Selection of the project's packages to build."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Dict, List, Mapping, Set

# Packages that projects vendor as source. They need old versions of Boost or pluginlib, and the simulation
# provides their function. Exact names where authors name packages of their own like these.
VENDORED_PACKAGES = re.compile(
    r"(openslam_gmapping|gmapping|slam_gmapping|yocs_.+|yujin_.+|ecl_.+|"
    r"amcl|map_server|move_base|move_slow_and_clear|navfn|nav_core|global_planner|base_local_planner|"
    r"dwa_local_planner|costmap_2d|voxel_grid|carrot_planner|clear_costmap_recovery|rotate_recovery|"
    r"fake_localization|robot_pose_ekf|depthimage_to_laserscan|gazebo_ros|gazebo_ros_control|gazebo_plugins|"
    r"gazebo_dev|gazebo_msgs|explore_lite|map_merge|rtabmap|rtabmap_ros|realsense_.+|freenect_.+|openni.*|"
    r"turtlebot_(actions|bringup|calibration|capabilities|dashboard|description|follower|gazebo|msgs|navigation|"
    r"interactive_markers|panorama|rapps|rviz_launchers|stage|stdr|teleop)|"
    r"kobuki_(auto_docking|bumper2pc|capabilities|controller_tutorial|core|dashboard|description|dock_drive|"
    r"driver|ftdi|gazebo|gazebo_plugins|keyop|led_controller|msgs|node|qtestsuite|random_walker|rapps|"
    r"rviz_launchers|safety_controller|soft|softapps|softnode|testsuite)|"
    r"create_(bringup|dashboard|description|driver|gazebo_plugins|msgs|node|robot))"
)
_COMPILED = re.compile(
    r"^\s*(?:add_executable|add_library|cuda_add_\w+|generate_messages)\s*\(", re.MULTILINE | re.IGNORECASE
)
_COMPONENTS = re.compile(r"find_package\s*\(\s*catkin\b([^)]*)\)", re.IGNORECASE)
_WORDS_OF_CMAKE = {"REQUIRED", "COMPONENTS", "QUIET", "OPTIONAL_COMPONENTS"}
_FIND = re.compile(r"\$\(find\s+([\w-]+)\)")


@dataclass(frozen=True)
class PackageSelection:
    """Packages of a project that are not built as they are.

    Attributes:
        replaced: Package that is replaced by one of this workspace -> reason.
        completed: Package whose files are used and whose programs are those of this workspace -> reason.
        unbuilt: Package of which only files, as launch files and worlds, are used -> reason.
        absent: Dependency that is not installed -> packages that declare it.
    """

    replaced: Dict[str, str]
    completed: Dict[str, str]
    unbuilt: Dict[str, str]
    absent: Dict[str, List[str]]


def select_packages(
    folders: Mapping[str, Path], stand_ins: Mapping[str, Path], is_installed: Callable[[str], bool]
) -> PackageSelection:
    """Select the packages to build.

    Args:
        folders: Package name -> folder, of the project.
        stand_ins: Package name -> folder, of this workspace's replacements for official packages.
        is_installed: Whether catkin finds a package outside of the project.
    """
    replaced: Dict[str, str] = {}
    completed: Dict[str, str] = {}
    unbuilt: Dict[str, str] = {}
    absent: Dict[str, List[str]] = {}
    for name, folder in sorted(folders.items()):
        cmake = _read(folder / "CMakeLists.txt")
        is_compiled = bool(_COMPILED.search(cmake))
        lost_parts = sorted(
            other for other in _found_in_xacro(folder) if other not in folders and not is_installed(other)
        )
        if name in stand_ins and lost_parts:
            replaced[name] = f"its robots need {', '.join(lost_parts)}, which is not installed"
        elif name in stand_ins and is_compiled and _has_nodes_or_messages(stand_ins[name]):
            completed[name] = "its sources do not build with current libraries"
        elif is_compiled and VENDORED_PACKAGES.fullmatch(name):
            unbuilt[name] = "its sources do not build with current libraries; not needed in simulation"
        else:
            for other in sorted(_components(cmake) - set(folders)):
                if not is_installed(other):
                    absent.setdefault(other, []).append(name)
    return PackageSelection(replaced, completed, unbuilt, absent)


def _has_nodes_or_messages(stand_in: Path) -> bool:
    return any((stand_in / part).is_dir() for part in ("nodes", "msg"))


def _components(cmake: str) -> Set[str]:
    text = " ".join(_COMPONENTS.findall(cmake))
    return {word for word in text.split() if re.fullmatch(r"[a-z]\w*", word) and word not in _WORDS_OF_CMAKE}


def _found_in_xacro(folder: Path) -> Set[str]:
    return {name for file in sorted(folder.rglob("*.xacro")) for name in _FIND.findall(_read(file))}


def _read(file: Path) -> str:
    """Text of a file without CMake comments; empty if it cannot be read."""
    try:
        return re.sub(r"#.*", "", file.read_text(errors="replace"))
    except OSError:
        return ""
