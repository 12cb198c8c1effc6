"""The robots that can be simulated, by name or by file."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Dict, Tuple

from planar.config.hints import hint
from sim_bridge.description import RobotProfile, read_robot_file, read_urdf_robot
from sim_bridge.description.urdf import FindFile, no_file
from sim_bridge.errors import RobotError

_URDF_FOLDER = Path(__file__).parent / "urdf"
# A name with one of these endings is a file's.
FILE_ENDINGS = (".urdf", ".xacro", ".xml")


def _profile(name: str, *files: str) -> RobotProfile:
    """A robot put together from URDF files: the first with the parts of the others added."""
    first, *others = (ElementTree.parse(str(_URDF_FOLDER / file)).getroot() for file in files)
    for other in others:
        first.extend(other)
    first.set("name", name)
    return read_urdf_robot(ElementTree.tostring(first, encoding="unicode"), name)


_FILES: Dict[str, Tuple[str, ...]] = {
    "turtlebot_lidar": ("turtlebot2.urdf", "lidar.urdf"),
    "turtlebot_kinect": ("turtlebot2.urdf", "kinect.urdf"),
    "turtlebot3_burger": ("turtlebot3_burger.urdf",),
    "turtlebot3_waffle": ("turtlebot3_waffle.urdf",),
    "jackal": ("jackal.urdf",),
}

ROBOTS: Dict[str, RobotProfile] = {name: _profile(name, *files) for name, files in _FILES.items()}


def robot_named(name: str, find_file: FindFile = no_file) -> RobotProfile:
    """The profile of that name, or the robot of that URDF or xacro file. Raises RobotError."""
    if name in ROBOTS:
        return ROBOTS[name]
    if name.endswith(FILE_ENDINGS):
        try:
            path = Path(name).expanduser()
        except RuntimeError as error:
            raise RobotError(f"{name}: cannot be read ({error})") from None
        return read_robot_file(path, find_file)
    known = f"known: {', '.join(ROBOTS)}, or a .urdf or .xacro file"
    raise RobotError(f"unknown robot {name!r}{hint(name, ROBOTS)} ({known})")
