"""Saved maps: key scans, their poses and the graph between them, in one versioned file."""

import io
import zipfile
from dataclasses import dataclass
from typing import List, Sequence

import numpy as np

from planar import PlanarError, Pose2, write_atomically
from slam_lite.pose_graph import Edges
from slam_lite.rendering import Beams
from slam_lite.surface import Surface

FORMAT = "slam_lite state"
VERSION = 2


class StateFileError(PlanarError):
    """A state file cannot be read; the text says why."""


@dataclass(frozen=True, eq=False)
class MapState:
    """All that is needed to go on mapping: ``poses`` (N, 3) of the keys, and where the robot was last."""

    surfaces: Sequence[Surface]
    beams: Sequence[Beams]
    poses: np.ndarray
    edges: Edges
    base_in_map: Pose2


def save_state(state: MapState, path) -> None:
    """Writes a state, whole or not at all. Raises FileWriteError."""
    file = io.BytesIO()
    np.savez_compressed(
        file,
        format=FORMAT,
        version=VERSION,
        points_xy=_joined([surface.points_xy for surface in state.surfaces], (0, 2)),
        normals_xy=_joined([surface.normals_xy for surface in state.surfaces], (0, 2)),
        point_counts=[len(surface) for surface in state.surfaces],
        ends_xy=_joined([beams.ends_xy for beams in state.beams], (0, 2)),
        marks=np.concatenate([np.zeros(0, dtype=bool), *(beams.marks for beams in state.beams)]),
        lasers_xy=np.array([beams.laser_xy for beams in state.beams]).reshape(-1, 2),
        beam_counts=[len(beams.marks) for beams in state.beams],
        poses=state.poses,
        base_in_map=state.base_in_map.as_array(),
        **{"edge_" + name: array for name, array in vars(state.edges).items()},
    )
    write_atomically(path, file.getvalue())


def load_state(path) -> MapState:
    """Reads what ``save_state`` wrote. Raises StateFileError."""
    try:
        with np.load(path, allow_pickle=False) as file:
            table = dict(file)
    except FileNotFoundError:
        raise StateFileError(f"{path}: no such state file") from None
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise StateFileError(f"{path}: not a readable state file ({error})") from None
    if str(table.get("format")) != FORMAT:
        raise StateFileError(f"{path}: not a state file of slam_lite")
    if int(table["version"]) != VERSION:
        raise StateFileError(f"{path}: version {int(table['version'])}, but this program reads {VERSION}")
    points = _split(table["points_xy"], table["point_counts"])
    normals = _split(table["normals_xy"], table["point_counts"])
    ends = _split(table["ends_xy"], table["beam_counts"])
    marks = _split(table["marks"], table["beam_counts"])
    return MapState(
        [Surface(*pair) for pair in zip(points, normals)],
        [Beams(*parts) for parts in zip(table["lasers_xy"], ends, marks)],
        table["poses"],
        Edges(*(table["edge_" + name] for name in ("nodes", "measured", "information", "is_loop"))),
        Pose2.from_array(table["base_in_map"]),
    )


def _joined(parts: Sequence[np.ndarray], empty_shape) -> np.ndarray:
    return np.concatenate([np.empty(empty_shape, dtype=np.float32), *parts])


def _split(array: np.ndarray, counts: np.ndarray) -> List[np.ndarray]:
    return np.split(array, np.cumsum(counts)[:-1]) if len(counts) else []
