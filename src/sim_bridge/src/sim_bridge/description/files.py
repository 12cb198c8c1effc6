"""Robot description files: URDF and xacro."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Dict

import defusedxml.ElementTree

from planar.files.reading import is_file, read_text
from sim_bridge.description.profile import RobotProfile
from sim_bridge.description.robot import read_urdf_robot
from sim_bridge.description.urdf import FindFile
from sim_bridge.errors import RobotError


def read_robot_file(path: Path, find_file: FindFile, arguments: Dict[str, str] = {}) -> RobotProfile:
    """Read the robot of a URDF or xacro file.

    Args:
        path: The file.
        find_file: Finds the files of package:// and model:// URIs.
        arguments: Arguments of the xacro.

    Raises:
        RobotError: The file cannot be used.
    """
    return read_urdf_robot(read_description(path, arguments), str(path), find_file)


def read_description(path: Path, arguments: Dict[str, str] = {}) -> str:
    """Return the URDF text of a URDF or xacro file.

    Args:
        path: The file.
        arguments: Arguments of the xacro, by name.

    Raises:
        RobotError: The file cannot be used; the text names it.
    """
    if path.suffix == ".xacro":
        return _expanded(path, arguments)
    try:
        return read_text(path)
    except (OSError, UnicodeDecodeError) as error:
        raise RobotError(f"{path}: cannot be read ({error})") from None


def _expanded(path: Path, arguments: Dict[str, str]) -> str:
    import xacro

    if not is_file(path):
        raise RobotError(f"{path}: cannot be read (no such file)")
    try:
        return xacro.process_file(str(path), mappings=dict(arguments)).toxml()
    except Exception as error:  # xacro's exceptions have no common class, and their texts several lines
        raise RobotError(f"{path}: not readable xacro ({' '.join(str(error).split())})") from None


def prefix_frames(name: str, urdf: str) -> str:
    """Return a URDF whose link names, which are the frames of tf, have a prefix.

    For robot_state_publisher, which does not support ``tf_prefix`` in Debian 11 (1.15.1).

    Args:
        name: The prefix, without slash.
        urdf: The URDF text.
    """
    robot = defusedxml.ElementTree.fromstring(urdf, forbid_dtd=False)
    for path, attribute in (("link", "name"), ("joint/parent", "link"), ("joint/child", "link")):
        for element in robot.findall(path):
            element.set(attribute, f"{name}/{element.get(attribute)}")
    return ElementTree.tostring(robot, encoding="unicode")
