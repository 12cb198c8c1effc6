"""Which of a project's packages are built, and which are left out, and why."""

import re
from pathlib import Path
from typing import Callable, Dict, Mapping, Optional, Set

# Packages of TurtleBot's time that projects carry along in source. Compiled, they ask for a Boost or a
# pluginlib of their day; in simulation nothing of them is needed that is not here already.
CARRIED_ALONG = re.compile(
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


def left_out(
    folders: Mapping[str, Path], stand_ins: Set[str], is_there: Callable[[str], bool]
) -> Dict[str, str]:
    """The packages to leave out of a project's ``folders``, with reasons.

    ``stand_ins``: packages of this workspace that stand in for official ones. ``is_there``: whether a package
    can be found by catkin outside the project.
    """
    reasons: Dict[str, str] = {}
    changed = True
    while changed:
        changed = False
        for name in sorted(set(folders) - set(reasons)):
            kept = set(folders) - set(reasons)
            reason = _reason(name, folders[name], stand_ins, kept, is_there)
            if reason:
                reasons[name] = reason
                changed = True
    return reasons


def _reason(
    name: str, folder: Path, stand_ins: Set[str], kept: Set[str], is_there: Callable[[str], bool]
) -> Optional[str]:
    cmake = _read(folder / "CMakeLists.txt")
    if _COMPILED.search(cmake):
        if name in stand_ins:
            return "this workspace has its own, and the sources of that time do not build"
        if CARRIED_ALONG.fullmatch(name):
            return "its sources do not build with today's libraries, and the simulation does not need it"
    missing = sorted(other for other in _components(cmake) - kept if not is_there(other))
    if missing:
        return f"needs {', '.join(missing)} to be built, which is not there"
    if name in stand_ins:
        missing = sorted(other for other in _found_in_xacro(folder) - kept if not is_there(other))
        if missing:
            return f"its robots need {', '.join(missing)}, which is not there; this workspace has its own"
    return None


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
