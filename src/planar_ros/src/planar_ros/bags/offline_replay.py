"""Shared parts of the commands that process a bag offline (amcl_lite_replay, slam_lite_replay)."""

import ctypes
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Iterable, Iterator, List, Optional, Type, TypeVar

import numpy as np

from planar import PlanarError, write_atomically
from planar.config.parameters import settings_from_yaml
from planar.files.writing import tum_text
from planar_ros.bags.bag_reader import BagError
from planar_ros.bags.scan_log import LoggedScan, NoResultError, ScanLog
from planar_ros.node.entry import use_one_blas_thread
from supervision.command_line import argument, option, parse

T = TypeVar("T")
# Parameters of mallopt, from malloc.h.
_M_MMAP_THRESHOLD, _M_TRIM_THRESHOLD = -3, -1
# Size from which an array is mapped, and unused memory kept at the end of the heap [bytes].
_MMAP_BYTES, _TRIM_BYTES = 2**20, 2**22


@dataclass(frozen=True)
class ReplayOptions:
    """Process a recorded bag, without a ROS master."""

    bag: str = argument("a ROS 1 bag with scans and /tf", metavar="BAG")
    config: Optional[Path] = option(None, "parameters of the node", type=Path, metavar="YAML")
    scan_topic: str = option("/scan", "topic of the scans", flag="--scan_topic", metavar="TOPIC")
    progress: bool = option(False, "show a progress bar")
    trajectory: Optional[Path] = option(
        None, "where to write the trajectory: a pose for every scan", type=Path, metavar="OUT.tum"
    )


Options = TypeVar("Options", bound=ReplayOptions)


def run_replay(
    kind: Type[Options],
    program: str,
    replay: Callable[[Options], int],
    arguments: Optional[List[str]],
) -> int:
    """Run a replay command.

    Args:
        kind: Its options.
        program: Its name.
        replay: The command; takes the options and returns the exit code.
        arguments: Command line arguments; None for those of the process.

    Returns:
        The exit code of ``replay``; 1 after a NoResultError and 2 after another PlanarError, which is printed
        in one line.
    """
    use_one_blas_thread()
    unmap_large_arrays()
    try:
        return replay(parse(kind, sys.argv[1:] if arguments is None else arguments, program))
    except PlanarError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1 if isinstance(error, NoResultError) else 2


def unmap_large_arrays() -> None:
    """Have glibc map large arrays, so that their memory is returned when they are freed.

    Otherwise they come from the heap, which long-lived arrays such as scans fragment.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_M_MMAP_THRESHOLD, _MMAP_BYTES)
        mallopt(_M_TRIM_THRESHOLD, _TRIM_BYTES)


def process_scans(
    log: ScanLog, process: Callable[[LoggedScan], None], activity: str, shows_progress: bool
) -> int:
    """Process the scans of a bag one by one; results up to an error or interruption stay valid.

    Args:
        log: Scans of the bag.
        process: Called with each scan.
        activity: Label of the progress bar.
        shows_progress: Whether to show a progress bar on stderr.

    Returns:
        Exit code: 0, 1 if the bag is truncated or broken, or 130 if interrupted.
    """
    try:
        for logged in _with_progress(log, activity) if shows_progress else log:
            process(logged)
    except BagError as error:
        warn(str(error))
        return 1
    except KeyboardInterrupt:
        warn(f"{log.path}: interrupted")
        return 130
    return 0


def _with_progress(log: ScanLog, activity: str) -> Iterator[LoggedScan]:
    from rich.console import Console  # imported late: most replays do not need its memory
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(activity, total=1.0)
        for logged in log:
            yield logged
            progress.update(task, completed=logged.position)


def load_settings(kind: Type[T], path: Optional[Path], also_known: Iterable[str] = ()) -> T:
    """Load settings from a YAML file; warn about unknown parameters.

    Args:
        kind: Settings dataclass.
        path: The file; None for the defaults.
        also_known: Parameters in the file that are valid but not part of ``kind``.

    Returns:
        The settings.

    Raises:
        SettingsError: If the file is unreadable or a value is invalid.
    """
    if path is None:
        return kind()
    settings, unknown = settings_from_yaml(kind, path)
    for name in unknown:
        if name not in also_known:
            warn(f"{path}: unknown parameter {name} ignored")
    return settings


def write_trajectory(path: Path, stamped_poses: np.ndarray) -> None:
    """Write a trajectory as a TUM file, atomically.

    Args:
        path: File to write.
        stamped_poses: Poses (N, 4) ``[t, x, y, yaw]`` [s, m, m, rad].

    Raises:
        FileWriteError: If the file cannot be written.
    """
    write_atomically(path, tum_text(stamped_poses).encode("ascii"))


def warn(text: str) -> None:
    """Print a warning on stderr."""
    print(f"warning: {text}", file=sys.stderr)
