"""Run folder: logs and result of a run."""

import contextlib
import json
from datetime import datetime
from pathlib import Path

from planar import SettingsError, write_atomically

RESULT_FILE = "result.json"


def create_run_folder(parent: Path, name: str) -> Path:
    """Create ``parent``/<date>-<time>-<name> with a folder ``log`` in it.

    Raises:
        SettingsError: If it cannot be created.
    """
    try:
        parent.mkdir(parents=True, exist_ok=True)
        folder = _new_folder(parent / f"{datetime.now():%Y%m%d-%H%M%S}-{name}")
        (folder / "log").mkdir()
    except OSError as error:
        raise SettingsError(f"{parent}: no run folder can be made there ({error.strerror})") from None
    return folder


def _new_folder(stem: Path) -> Path:
    """Create a folder under the first free name; another run may take a name at any moment."""
    folder, number = stem, 1
    while True:
        with contextlib.suppress(FileExistsError):
            folder.mkdir()
            return folder
        number += 1
        folder = stem.with_name(f"{stem.name}-{number}")


def write_result(folder: Path, result: dict) -> Path:
    """Write result.json atomically."""
    path = folder / RESULT_FILE
    write_atomically(path, (json.dumps(result, indent=2) + "\n").encode("utf-8"))
    return path
