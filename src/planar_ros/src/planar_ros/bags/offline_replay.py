"""What commands share that work through a bag offline."""

import argparse
import ctypes
import sys
from pathlib import Path
from typing import Callable, Iterable, Iterator, List, Optional, Type, TypeVar

import numpy as np

from planar import PlanarError, write_atomically
from planar.config.parameters import settings_from_yaml
from planar.files.writing import tum_text
from planar_ros.bags.bag_reader import BagError
from planar_ros.bags.scan_log import LoggedScan, ScanLog
from planar_ros.node.entry import use_one_blas_thread

T = TypeVar("T")
# Of malloc.h; and from how many bytes on an array is large, and how many may lie idle at the heap's end.
_M_MMAP_THRESHOLD, _M_TRIM_THRESHOLD = -3, -1
_LARGE, _SPARE = 2**20, 2**22


def add_replay_options(parser: argparse.ArgumentParser, node: str) -> None:
    """Options of every replay; ``node``: whose parameters ``--config`` holds."""
    parser.add_argument("bag", metavar="BAG", help="a ROS 1 bag with scans and /tf")
    parser.add_argument("--config", metavar="YAML", type=Path, help=f"parameters of {node}")
    parser.add_argument("--scan_topic", default="/scan", help="default: /scan")
    parser.add_argument("--progress", action="store_true", help="show how far it is")


def run_replay(
    parser: argparse.ArgumentParser,
    replay: Callable[[argparse.Namespace], int],
    arguments: Optional[List[str]],
) -> int:
    """The exit code of ``replay``; 2 if it came to nothing, which is told in a line."""
    use_one_blas_thread()
    unmap_large_arrays()
    try:
        return replay(parser.parse_args(arguments))
    except PlanarError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def unmap_large_arrays() -> None:
    """Large arrays are mapped, and unmapped when they are freed.

    Otherwise glibc takes them from its heap, where what is kept, like scans, soon lies between them.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_M_MMAP_THRESHOLD, _LARGE)
        mallopt(_M_TRIM_THRESHOLD, _SPARE)


def process_scans(
    log: ScanLog, use: Callable[[LoggedScan], None], activity: str, shows_progress: bool
) -> int:
    """Hands the scans to ``use``, one by one; returns 0, 1 if the bag broke off, or 130 if interrupted.

    What has been made of the scans so far is good in any case.
    """
    try:
        for logged in _watched(log, activity) if shows_progress else log:
            use(logged)
    except BagError as error:
        warn(str(error))
        return 1
    except KeyboardInterrupt:
        warn(f"{log.path}: interrupted")
        return 130
    return 0


def _watched(log: ScanLog, activity: str) -> Iterator[LoggedScan]:
    """The scans; meanwhile it is shown how far they have been used."""
    from rich.console import Console  # late: it takes memory that most replays can do without
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(activity, total=1.0)
        for logged in log:
            yield logged
            progress.update(task, completed=logged.position)


def load_settings(kind: Type[T], path: Optional[Path], also_known: Iterable[str] = ()) -> T:
    """Settings from a YAML file, if there is one; unknown names are warned of. Raises SettingsError."""
    if path is None:
        return kind()
    settings, unknown = settings_from_yaml(kind, path)
    for name in unknown:
        if name not in also_known:
            warn(f"{path}: {name} has no meaning here")
    return settings


def write_trajectory(path: Path, stamped_poses: np.ndarray) -> None:
    """Poses (N, 4) ``[t, x, y, yaw]`` as a TUM file, or nothing at all. Raises FileWriteError."""
    write_atomically(path, tum_text(stamped_poses).encode("ascii"))


def warn(text: str) -> None:
    print(f"warning: {text}", file=sys.stderr)
