"""The built-in robots, and your own robot from a URDF or xacro file (docs/get_started/own_robot.md)."""

import xml.etree.ElementTree as ElementTree
from functools import lru_cache
from pathlib import Path
from typing import Dict, Iterator, Mapping, Tuple

from planar.config.hints import hint
from sim_bridge.config import is_robot_file
from sim_bridge.description import RobotProfile, read_robot_file, read_urdf_robot
from sim_bridge.description.urdf import FindFile, no_file
from sim_bridge.errors import RobotError

_URDF_FOLDER = Path(__file__).parent / "urdf"


@lru_cache(maxsize=None)
def _profile(name: str) -> RobotProfile:
    """Return a robot of several URDF files: the first one with the elements of the others added."""
    first, *others = (ElementTree.parse(str(_URDF_FOLDER / file)).getroot() for file in _FILES[name])
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


class _BuiltInRobots(Mapping[str, RobotProfile]):
    """The built-in robots by name; each is read when it is first used."""

    def __getitem__(self, name: str) -> RobotProfile:
        return _profile(name)

    def __iter__(self) -> Iterator[str]:
        return iter(_FILES)

    def __len__(self) -> int:
        return len(_FILES)


ROBOTS = _BuiltInRobots()


def robot_named(name: str, find_file: FindFile = no_file) -> RobotProfile:
    """Return a built-in robot, or the robot of a file.

    Args:
        name: One of ROBOTS, or the path of a .urdf or .xacro file.
        find_file: Finds the files of package:// and model:// URIs.

    Raises:
        RobotError: There is no such robot, or the file cannot be used.
    """
    if name in ROBOTS:
        return ROBOTS[name]
    if is_robot_file(name):
        try:
            path = Path(name).expanduser()
        except RuntimeError as error:
            raise RobotError(f"{name}: cannot be read ({error})") from None
        return read_robot_file(path, find_file)
    known = f"known: {', '.join(ROBOTS)}, or a .urdf or .xacro file"
    raise RobotError(f"unknown robot {name!r}{hint(name, ROBOTS)} ({known})")
