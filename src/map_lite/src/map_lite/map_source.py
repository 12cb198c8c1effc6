"""Location of the map that is served: the command line, and the URLs of nav_msgs/LoadMap."""

import argparse
import re
from pathlib import Path
from typing import Callable, List, Optional

from planar.maps.map_file import MapMissingError

_LEADING_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)


def parse_arguments(words: List[str]) -> argparse.Namespace:
    """Parse the command line of map_server.

    Further arguments are an error, as in the official map_server.

    Args:
        words: Command line without the program's name.

    Returns:
        Namespace of ``map`` (path or URL) and ``resolution`` [m per pixel], None if it is not given.
    """
    parser = argparse.ArgumentParser(prog="map_server", description="Serve a map file.")
    parser.add_argument("map", help="YAML file of the map, or (deprecated) its image")
    parser.add_argument(
        "resolution", nargs="?", type=parse_resolution, help="metres per pixel, with an image (deprecated)"
    )
    return parser.parse_args(words)


def parse_resolution(word: str) -> Optional[float]:
    """Read a resolution as C's ``atof`` does.

    Args:
        word: Text that may start with a number.

    Returns:
        Metres per pixel; None, as if it was omitted, without a leading number or if it is 0.
    """
    number = _LEADING_NUMBER.match(word)
    return (float(number.group()) if number else 0.0) or None


def resolve_map_url(map_url: str, package_path: Callable[[str], str]) -> Path:
    """Resolve a path, or a ``file://`` or ``package://`` URL, to a file.

    Args:
        map_url: The path or URL.
        package_path: Returns the folder of a ROS package, or raises LookupError.

    Returns:
        Path of the file, which may not exist.

    Raises:
        MapMissingError: The package is unknown, or the URL is of another kind.
    """
    if map_url.startswith("file://"):
        return Path(map_url[len("file://") :])
    if map_url.startswith("package://"):
        package, _, inner = map_url[len("package://") :].partition("/")
        try:
            return Path(package_path(package)) / inner
        except LookupError:
            raise MapMissingError(f"{map_url}: no package {package}") from None
    if "://" in map_url:
        raise MapMissingError(f"{map_url}: neither a path nor a file:// or package:// URL")
    return Path(map_url)
