"""Write the report into a run folder."""

import io
from functools import partial
from pathlib import Path
from typing import Any, Callable, List, Mapping, Tuple

from planar import PlanarError, write_atomically
from planar.files.writing import tum_text
from run_report.page import report_html
from run_report.picture import run_frames, run_picture, save_animation
from run_report.record import RunRecord, save_record

TRAJECTORIES = (
    ("truth", "trajectory_true"),
    ("estimate", "trajectory_estimated"),
    ("odometry", "trajectory_odometry"),
)


def write_report(
    folder: Path, result: Mapping[str, Any], record: RunRecord, with_gif: bool = False
) -> List[str]:
    """Write trajectories, record.json, run.png, report.html and optionally run.gif.

    A file that cannot be written does not keep the others from being written.

    Args:
        folder: Run folder.
        result: Content of result.json.
        record: Record of the run.
        with_gif: Write run.gif, too.

    Returns:
        What is missing, in words; the page lists it, too.
    """
    works: List[Tuple[str, Callable[[], object]]] = [
        (f"{stem}.tum", partial(_write_trajectory, folder, stem, getattr(record, name)))
        for name, stem in TRAJECTORIES
    ]
    works.append(("record.json", partial(save_record, folder, record)))
    works.append(("run.png", partial(_write_picture, folder, result, record)))
    missing = list(result.get("missing", ()))
    for name, work in works:
        _attempt(name, work, missing)
    _write_page(folder, result, record, missing)
    if with_gif and not _attempt("run.gif", partial(_write_animation, folder, result, record), missing):
        _write_page(folder, result, record, missing)
    return list(dict.fromkeys(missing))


def _attempt(name: str, work: Callable[[], object], missing: List[str]) -> bool:
    try:
        work()
    except PlanarError as error:
        missing.append(f"{name}: {str(error).rpartition(': ')[2]}")
        return False
    return True


def _write_page(folder: Path, result: Mapping[str, Any], record: RunRecord, missing: List[str]) -> None:
    page = report_html({**result, "missing": missing}, record).encode("utf-8")
    _attempt("report.html", partial(write_atomically, folder / "report.html", page), missing)


def _write_trajectory(folder: Path, stem: str, rows) -> None:
    if len(rows):
        write_atomically(folder / f"{stem}.tum", tum_text(rows).encode("ascii"))


def _write_picture(folder: Path, result: Mapping[str, Any], record: RunRecord) -> None:
    stream = io.BytesIO()
    run_picture(result, record).save(stream, "PNG")
    write_atomically(folder / "run.png", stream.getvalue())


def _write_animation(folder: Path, result: Mapping[str, Any], record: RunRecord) -> None:
    frames = list(run_frames(result, record))
    if frames:
        stream = io.BytesIO()
        save_animation(stream, frames)
        write_atomically(folder / "run.gif", stream.getvalue())
