"""Names of map files: plain paths and the URLs that nav_msgs/LoadMap speaks of."""

from pathlib import Path
from typing import Callable

from planar.maps.map_file import MapMissingError


def path_of(map_url: str, package_path: Callable[[str], str]) -> Path:
    """The file that a path or a ``file://`` or ``package://`` URL names; ``package_path`` finds packages
    or raises LookupError. Raises MapMissingError.
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
