"""The folder in which a run leaves its logs and its result."""

import json
from datetime import datetime
from pathlib import Path

from planar import write_atomically


def create_run_folder(parent: Path, name: str) -> Path:
    """A new folder ``parent``/<date>-<time>-<name> with a folder ``log`` in it."""
    stem = f"{datetime.now():%Y%m%d-%H%M%S}-{name}"
    for suffix in ("", *(f"-{n}" for n in range(2, 1000))):
        folder = parent / (stem + suffix)
        try:
            (folder / "log").mkdir(parents=True)
            return folder
        except FileExistsError:
            continue
    raise FileExistsError(f"{parent}: no name left for a run folder")


def write_result(folder: Path, result: dict) -> Path:
    """Writes result.json, whole or not at all."""
    path = folder / "result.json"
    write_atomically(path, (json.dumps(result, indent=2) + "\n").encode("utf-8"))
    return path
