"""Record of a run, in simulated seconds and in the map frame."""

import base64
import io
import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple, Optional, get_type_hints

import numpy as np
from PIL import Image

from planar import OccupancyGrid, PlanarError, Pose2, write_atomically
from planar.files.reading import read_text

FILE_NAME = "record.json"
DECIMALS = 4


class RecordError(PlanarError):
    """The record of a run is missing or broken."""


class StateEvent(NamedTuple):
    """The mission changed to this state."""

    stamp: float
    name: str


class GoalEvent(NamedTuple):
    """A goal was sent."""

    stamp: float
    x: float
    y: float
    yaw: float


class MarkerEvent(NamedTuple):
    """A marker was shown at x, y, or hidden."""

    stamp: float
    name: str
    is_shown: bool
    x: float
    y: float


class CollisionEvent(NamedTuple):
    """The robot touched ``name``."""

    stamp: float
    name: str


class LoggedWarning(NamedTuple):
    """A node logged a warning or an error."""

    stamp: float
    node: str
    text: str


class ZoneRecord(NamedTuple):
    """A named place of the mission."""

    name: str
    x: float
    y: float
    yaw: float
    radius: float


EVENTS: Dict[str, Callable[..., Any]] = {
    "states": StateEvent,
    "goals": GoalEvent,
    "markings": MarkerEvent,
    "collisions": CollisionEvent,
    "warnings": LoggedWarning,
    "zones": ZoneRecord,
}


def _rows(columns: int):
    return field(default_factory=lambda: np.zeros((0, columns)))


@dataclass(eq=False)
class RunRecord:
    """Record of a run. Stamps are simulated seconds.

    Attributes:
        truth: (N, 4), stamp, x, y, yaw: true pose.
        estimate: (N, 4), the same as estimated by localization.
        odometry: (N, 4), the same by odometry alone, starting at the first true pose.
        velocity: (N, 3), stamp, true linear [m/s] and angular velocity [rad/s].
        pace: (N, 2), stamp, wall-clock seconds since the start.
        plans: First plan for each goal, each (N, 2), x, y.
        states: States of the mission.
        goals: Goals sent to move_base.
        markings: Changes of markers.
        collisions: Contacts of the robot.
        warnings: Warnings and errors of nodes.
        zones: Places of the mission.
        grid: Last map.
    """

    truth: np.ndarray = _rows(4)
    estimate: np.ndarray = _rows(4)
    odometry: np.ndarray = _rows(4)
    velocity: np.ndarray = _rows(3)
    pace: np.ndarray = _rows(2)
    plans: List[np.ndarray] = field(default_factory=list)
    states: List[StateEvent] = field(default_factory=list)
    goals: List[GoalEvent] = field(default_factory=list)
    markings: List[MarkerEvent] = field(default_factory=list)
    collisions: List[CollisionEvent] = field(default_factory=list)
    warnings: List[LoggedWarning] = field(default_factory=list)
    zones: List[ZoneRecord] = field(default_factory=list)
    grid: Optional[OccupancyGrid] = None

    @property
    def end(self) -> float:
        """Last stamp."""
        return float(self.truth[-1, 0]) if len(self.truth) else 0.0


# Errors of json, numpy and Pillow for broken records.
UNREADABLE = (OSError, ValueError, LookupError, TypeError, ArithmeticError, RecursionError, PlanarError)
SERIES = ("truth", "estimate", "odometry", "velocity", "pace")


def save_record(folder: Path, record: RunRecord) -> Path:
    """Write record.json atomically."""
    content: Dict[str, Any] = {name: _rounded(getattr(record, name)) for name in SERIES}
    content["plans"] = [_rounded(plan) for plan in record.plans]
    content.update({name: getattr(record, name) for name in EVENTS})
    content["grid"] = None if record.grid is None else _packed(record.grid)
    path = folder / FILE_NAME
    write_atomically(path, json.dumps(content, separators=(",", ":")).encode("utf-8"))
    return path


def load_record(folder: Path) -> RunRecord:
    """Read the record of a run folder.

    Raises:
        RecordError: If it is missing or broken.
    """
    path = folder / FILE_NAME
    try:
        content = json.loads(read_text(path))
        _check_kinds(content)
        record = RunRecord(plans=[np.array(plan, dtype=float).reshape(-1, 2) for plan in content["plans"]])
        for name in SERIES:
            columns = getattr(record, name).shape[1]
            setattr(record, name, np.array(content[name], dtype=float).reshape(-1, columns))
        for name, kind in EVENTS.items():
            setattr(record, name, [kind(*event) for event in content[name]])
        record.grid = None if content["grid"] is None else _unpacked(content["grid"])
    except FileNotFoundError:
        raise RecordError(f"{path}: no such file; a run that ended at once leaves none") from None
    except UNREADABLE as error:
        raise RecordError(f"{path}: not the record of a run ({error!r})") from None
    return record


def _check_kinds(content: Any) -> None:
    """Raise TypeError if a number or text of an event has the wrong type, since pages rely on it."""
    for name, kind in EVENTS.items():
        for event in content[name]:
            for value, wanted in zip(event, get_type_hints(kind).values()):
                fits = isinstance(value, (int, float) if wanted is float else wanted)
                if not fits or (wanted is float and not math.isfinite(value)):
                    raise TypeError(f"{name}: {value!r} is no {wanted.__name__}")


def _rounded(rows: np.ndarray) -> list:
    return np.round(rows, DECIMALS).tolist()


def _packed(grid: OccupancyGrid) -> Dict[str, Any]:
    """Encode a grid as 8-bit PNG of its values, unknown being 255, lowest row first."""
    stream = io.BytesIO()
    Image.fromarray(grid.cells.view(np.uint8)).save(stream, "PNG")
    png = base64.b64encode(stream.getvalue()).decode("ascii")
    return {"png": png, "resolution": grid.resolution, "origin": grid.origin.as_array().tolist()}


def _unpacked(packed: Dict[str, Any]) -> OccupancyGrid:
    try:
        with Image.open(io.BytesIO(base64.b64decode(packed["png"]))) as image:
            cells = np.array(image).view(np.int8)
    except Exception as error:  # Pillow's errors for broken files have no common class
        raise ValueError(f"grid: no picture ({error})") from None
    return OccupancyGrid(cells, float(packed["resolution"]), Pose2.from_array(packed["origin"]))
