"""The script render_map: the true map of a world, and an image of it from above."""

import argparse
import io
import sys
from pathlib import Path

import numpy as np
from PIL import Image

from planar import PlanarError, save_map, write_atomically
from sim_bridge.ros.description import model_folders
from sim_bridge.sdf import load_world
from sim_bridge.views.top_view import render_top_view
from sim_bridge.views.true_map import true_map


def render_map() -> None:
    """Write the true map of a world file, and optionally an image of it."""
    parser = argparse.ArgumentParser(
        prog="render_map",
        description="Renders the occupancy grid of a world file, as a perfect mapper would.",
    )
    parser.add_argument("world", metavar="WORLD", help="SDF world file")
    parser.add_argument("stem", metavar="STEM", help="writes STEM.yaml and STEM.pgm")
    parser.add_argument("--height", type=float, default=0.3, help="of the section, metres (default: 0.3)")
    parser.add_argument("--resolution", type=float, default=0.05, help="metres per cell (default: 0.05)")
    parser.add_argument(
        "--inside",
        type=float,
        nargs=2,
        default=(0.0, 0.0),
        metavar=("X", "Y"),
        help="a point in free space; cells reachable from it are free (default: 0 0)",
    )
    parser.add_argument("--picture", metavar="PNG", help="also writes an image of the world from above")
    parser.add_argument(
        "--below", type=float, default=2.0, help="greatest height shown in the image, metres (default: 2)"
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
            picture = render_top_view(world, arguments.below, warn=_warn)
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
