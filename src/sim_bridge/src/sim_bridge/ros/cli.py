"""Command lines that need no ROS master."""

import argparse
import io
import os
import sys
from pathlib import Path
from typing import List, Optional
from urllib.parse import unquote, urlparse

import numpy as np
from PIL import Image
from rospkg import ResourceNotFound, RosPack

from planar import PlanarError, save_map, write_atomically
from sim_bridge.description.frames import with_frames_of
from sim_bridge.robots import ROBOTS, robot_named
from sim_bridge.sdf import load_world
from sim_bridge.sdf.includes import resolve
from sim_bridge.views.picture import picture_from_above
from sim_bridge.views.true_map import true_map


def model_folders() -> List[Path]:
    """Where Gazebo looks for models: the folders of GAZEBO_MODEL_PATH, then the user's own."""
    listed = [Path(folder) for folder in os.environ.get("GAZEBO_MODEL_PATH", "").split(":") if folder]
    return [*listed, Path("~/.gazebo/models").expanduser()]


def find_file(uri: str) -> Optional[Path]:
    """The file that a robot's description names: ``package://``, ``model://``, ``file://`` or a path."""
    parts = urlparse(uri)
    if parts.scheme != "package":
        return resolve(uri, Path.cwd(), model_folders())
    try:
        path = Path(RosPack().get_path(parts.netloc)) / unquote(parts.path).lstrip("/")
    except ResourceNotFound:
        return None
    return path if path.exists() else None


def render_map() -> None:
    """Writes the true map of a world file, and a picture of it."""
    parser = argparse.ArgumentParser(
        prog="render_map",
        description="Renders the occupancy grid of a world file, as a perfect mapper would.",
    )
    parser.add_argument("world", metavar="WORLD", help="SDF world file")
    parser.add_argument("stem", metavar="STEM", help="writes STEM.yaml and STEM.pgm")
    parser.add_argument("--height", type=float, default=0.3, help="of the cut, metres (default: 0.3)")
    parser.add_argument("--resolution", type=float, default=0.05, help="metres per cell (default: 0.05)")
    parser.add_argument(
        "--inside",
        type=float,
        nargs=2,
        default=(0.0, 0.0),
        metavar=("X", "Y"),
        help="a point of free space; what can be reached from it is free (default: 0 0)",
    )
    parser.add_argument("--picture", metavar="PNG", help="writes a picture of the world from above there too")
    parser.add_argument(
        "--below", type=float, default=2.0, help="what the picture leaves out is higher, metres (default: 2)"
    )
    parser.add_argument("--strict", action="store_true", help="a mesh or model that is missing is an error")
    arguments = parser.parse_args()
    if not arguments.resolution > 0.0:
        parser.error(f"--resolution must be positive, got {arguments.resolution:g}")
    try:
        world = load_world(arguments.world, model_folders(), arguments.strict)
        for warning in world.warnings:
            _warn(warning)
        if arguments.picture:
            picture = picture_from_above(world, arguments.below, warn=_warn)
            _save_picture(picture, Path(arguments.picture))
        grid = true_map(world, arguments.height, arguments.resolution, tuple(arguments.inside))
        print(f"{save_map(grid, arguments.stem)}: {grid.cols} x {grid.rows} cells of {grid.resolution:g} m")
    except PlanarError as error:
        parser.exit(2, f"render_map: error: {error}\n")


def _warn(text: str) -> None:
    print(f"warning: {text}", file=sys.stderr)


def _save_picture(picture: np.ndarray, path: Path) -> None:
    content = io.BytesIO()
    Image.fromarray(picture).save(content, "PNG")
    write_atomically(path, content.getvalue())


def robot_description() -> None:
    """Prints the URDF of a robot."""
    parser = argparse.ArgumentParser(
        prog="robot_description", description="Prints the URDF of a robot that sim_bridge simulates."
    )
    parser.add_argument("robot", metavar="ROBOT", help=", ".join(ROBOTS) + "; or a .urdf or .xacro file")
    parser.add_argument("--frames", metavar="NAME", help="puts NAME/ before the names of its frames")
    arguments = parser.parse_args()
    try:
        urdf = robot_named(arguments.robot, find_file).description()
    except PlanarError as error:
        parser.exit(2, f"robot_description: error: {error}\n")
    print(with_frames_of(arguments.frames, urdf) if arguments.frames else urdf)
