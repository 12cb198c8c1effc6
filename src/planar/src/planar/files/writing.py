"""Atomic writing of files, and trajectories in the TUM format."""

import math
import os
import tempfile
from pathlib import Path
from typing import Dict, Iterable, Mapping

import numpy as np

from planar.errors import FileWriteError


def write_atomically(path, data: bytes) -> None:
    """Write a temporary file beside ``path`` and rename it, so that readers never see a partial file.

    Raises:
        FileWriteError: If it cannot be written; the old file is kept.
    """
    write_all_atomically({Path(path): [data]})


def write_all_atomically(files: Mapping[Path, Iterable[bytes]]) -> None:
    """Write several files beside their paths, then rename all of them; on a full disk the old files are kept.

    Args:
        files: Content of each file in chunks, so that large files need not be held in memory.

    Raises:
        FileWriteError: If one of them cannot be written.
    """
    written: Dict[Path, Path] = {}
    try:
        for path, chunks in files.items():
            descriptor, name = tempfile.mkstemp(dir=str(path.parent), prefix=path.name + ".")
            written[path] = Path(name)
            with os.fdopen(descriptor, "wb") as file:
                file.writelines(chunks)
            written[path].chmod(0o644)
        for path in files:
            written[path].replace(path)
    except OSError as error:
        raise FileWriteError(f"{path}: cannot be written ({error.strerror})") from None
    finally:
        for beside in written.values():
            beside.unlink(missing_ok=True)


def tum_text(stamped_poses: np.ndarray) -> str:
    """Return a trajectory in the TUM format, which evo reads: lines ``t x y z qx qy qz qw``.

    Args:
        stamped_poses: Stamps [s] and poses, (N, 4) ``[t, x, y, yaw]``.
    """
    return "".join(
        f"{t:.9f} {x:.6f} {y:.6f} 0 0 0 {math.sin(yaw / 2.0):.9f} {math.cos(yaw / 2.0):.9f}\n"
        for t, x, y, yaw in stamped_poses
    )
