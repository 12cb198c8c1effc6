"""Robot descriptions, and the files that they refer to."""

import argparse
import os
from pathlib import Path
from typing import List, Optional
from urllib.parse import unquote

from rospkg import ResourceNotFound, RosPack

from planar import PlanarError
from sim_bridge.description.files import prefix_frames
from sim_bridge.robots import ROBOTS, robot_named
from sim_bridge.sdf.includes import parts_of, resolve


def model_folders() -> List[Path]:
    """Return the folders of models: those of GAZEBO_MODEL_PATH, then ~/.gazebo/models."""
    listed = [Path(folder) for folder in os.environ.get("GAZEBO_MODEL_PATH", "").split(":") if folder]
    return [*listed, Path("~/.gazebo/models").expanduser()]


def find_file(uri: str) -> Optional[Path]:
    """Return the file of a URI (``package://``, ``model://``, ``file://``) or path; None if there is none."""
    parts = parts_of(uri)
    if parts is None or parts.scheme != "package":
        return resolve(uri, Path.cwd(), model_folders())
    try:
        path = Path(RosPack().get_path(parts.netloc)) / unquote(parts.path).lstrip("/")
    except ResourceNotFound:
        return None
    return path if path.exists() else None


def robot_description() -> None:
    """Print the URDF of a robot (script robot_description)."""
    parser = argparse.ArgumentParser(
        prog="robot_description", description="Prints the URDF of a robot that sim_bridge simulates."
    )
    parser.add_argument("robot", metavar="ROBOT", help=", ".join(ROBOTS) + "; or a .urdf or .xacro file")
    parser.add_argument(
        "--frames", metavar="NAME", help="prefix of its frames: NAME/base_link instead of base_link"
    )
    arguments = parser.parse_args()
    try:
        urdf = robot_named(arguments.robot, find_file).description()
    except PlanarError as error:
        parser.exit(2, f"robot_description: error: {error}\n")
    print(prefix_frames(arguments.frames, urdf) if arguments.frames else urdf)
