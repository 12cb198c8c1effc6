"""Files written whole or not at all."""

import math
import os
import tempfile
from pathlib import Path
from typing import Dict, Iterable, Mapping

import numpy as np

from planar.errors import PlanarError


class FileWriteError(PlanarError):
    """A file cannot be written; what was there before still is. The text names it."""


def write_atomically(path, data: bytes) -> None:
    """Writes beside ``path``, then renames, so that no reader sees half a file. Raises FileWriteError."""
    write_all_atomically({Path(path): [data]})


def write_all_atomically(files: Mapping[Path, Iterable[bytes]]) -> None:
    """Writes all files beside their paths, then renames them: on a full disk the old ones stay.

    Each is told in chunks, so that one which is made while it is written need not be held in memory.
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
    """Stamps and poses (N, 4) as lines ``t x y z qx qy qz qw`` (the TUM format, which evo reads)."""
    return "".join(
        f"{t:.9f} {x:.6f} {y:.6f} 0 0 0 {math.sin(yaw / 2.0):.9f} {math.cos(yaw / 2.0):.9f}\n"
        for t, x, y, yaw in stamped_poses
    )
