"""Which of a project's packages are built, and which are left out, and why."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Dict, List, Mapping, Set

# Packages of TurtleBot's time that projects carry along in source. Compiled, they ask for a Boost or a
# pluginlib of their day; in simulation nothing of them is needed that is not here already.
VENDORED_PACKAGES = re.compile(
    r"(openslam_gmapping|gmapping|slam_gmapping|turtlebot_.+|kobuki_.+|yocs_.+|yujin_.+|ecl_.+|create_.+|"
    r"amcl|map_server|move_base|move_slow_and_clear|navfn|nav_core|global_planner|base_local_planner|"
    r"dwa_local_planner|costmap_2d|voxel_grid|carrot_planner|clear_costmap_recovery|rotate_recovery|"
    r"fake_localization|robot_pose_ekf|depthimage_to_laserscan|gazebo_ros|gazebo_ros_control|gazebo_plugins|"
    r"gazebo_dev|gazebo_msgs|explore|explore_lite|map_merge|rtabmap|rtabmap_ros|realsense_.+|freenect_.+|openni.*)"
)
_COMPILED = re.compile(
    r"^\s*(?:add_executable|add_library|cuda_add_\w+|generate_messages)\s*\(", re.MULTILINE | re.IGNORECASE
)
_COMPONENTS = re.compile(r"find_package\s*\(\s*catkin\b([^)]*)\)", re.IGNORECASE)
_WORDS_OF_CMAKE = {"REQUIRED", "COMPONENTS", "QUIET", "OPTIONAL_COMPONENTS"}
_FIND = re.compile(r"\$\(find\s+([\w-]+)\)")


@dataclass(frozen=True)
class PackageSelection:
    """What is not built of a project, and why.

    ``replaced``: packages whose place ours take. ``unbuilt``: packages of which only the files are used, as
    launch files and worlds. ``absent``: packages that are nowhere, each with those that ask for it.
    """

    replaced: Dict[str, str]
    unbuilt: Dict[str, str]
    absent: Dict[str, List[str]]


def select_packages(
    folders: Mapping[str, Path], stand_ins: Mapping[str, Path], is_installed: Callable[[str], bool]
) -> PackageSelection:
    """Divides the packages in a project's ``folders``.

    ``stand_ins``: the folders of this workspace's packages that stand in for official ones. ``is_there``:
    whether a package can be found by catkin outside the project.
    """
    replaced: Dict[str, str] = {}
    unbuilt: Dict[str, str] = {}
    absent: Dict[str, List[str]] = {}
    for name, folder in sorted(folders.items()):
        cmake = _read(folder / "CMakeLists.txt")
        is_compiled = bool(_COMPILED.search(cmake))
        lost_parts = sorted(
            other for other in _found_in_xacro(folder) if other not in folders and not is_installed(other)
        )
        if name in stand_ins and lost_parts:
            replaced[name] = f"its robots need {', '.join(lost_parts)}, which is not there"
        elif name in stand_ins and is_compiled and _has_nodes_or_messages(stand_ins[name]):
            replaced[name] = "sources of that time do not build today"
        elif is_compiled and VENDORED_PACKAGES.fullmatch(name):
            unbuilt[name] = "sources of that time do not build today; the simulation does without"
        else:
            for other in sorted(_components(cmake) - set(folders)):
                if not is_installed(other):
                    absent.setdefault(other, []).append(name)
    return PackageSelection(replaced, unbuilt, absent)


def _has_nodes_or_messages(stand_in: Path) -> bool:
    return any((stand_in / part).is_dir() for part in ("nodes", "msg"))


def _components(cmake: str) -> Set[str]:
    text = " ".join(_COMPONENTS.findall(cmake))
    return {word for word in text.split() if re.fullmatch(r"[a-z]\w*", word) and word not in _WORDS_OF_CMAKE}


def _found_in_xacro(folder: Path) -> Set[str]:
    return {name for file in sorted(folder.rglob("*.xacro")) for name in _FIND.findall(_read(file))}


def _read(file: Path) -> str:
    """The text without the comments of CMake."""
    try:
        return re.sub(r"#.*", "", file.read_text(errors="replace"))
    except OSError:
        return ""
