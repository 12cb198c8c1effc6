"""Saved maps: keyframes, their poses and the pose graph, in one versioned file."""

import io
from dataclasses import dataclass
from typing import Dict, List, Mapping, Sequence

import numpy as np

from planar import PlanarError, Pose2, write_atomically
from planar.files.reading import read_arrays
from planar.geometry.limits import MAX_COORDINATE
from slam_lite.graph.pose_graph import Edges
from slam_lite.point_cloud import PointCloud
from slam_lite.rendering import ScanBeams

FORMAT = "slam_lite state"
VERSION = 2


class StateFileError(PlanarError):
    """A state file cannot be read; the text states the file and the reason."""


@dataclass(frozen=True, eq=False)
class MapState:
    """State that is needed to resume mapping.

    Attributes:
        clouds: Points of all keyframes, each in its base frame, N.
        beams: Beams of all keyframes, N.
        poses: (N, 3), poses of all keyframes in the map frame.
        edges: Edges of the pose graph.
        base_in_map: Robot pose at the last scan.
        sessions: (N,), number of each keyframe's session, ascending.
    """

    clouds: Sequence[PointCloud]
    beams: Sequence[ScanBeams]
    poses: np.ndarray
    edges: Edges
    base_in_map: Pose2
    sessions: np.ndarray


def save_state(state: MapState, path, is_compressed: bool = True) -> None:
    """Write a state file, completely or not at all.

    Args:
        state: State to write.
        path: State file.
        is_compressed: Whether to compress it; uncompressed, writing takes a tenth of the time and a fifth
            more space.

    Raises:
        FileWriteError: The file cannot be written.
    """
    file = io.BytesIO()
    save = np.savez_compressed if is_compressed else np.savez
    save(
        file,
        format=FORMAT,
        version=VERSION,
        points_xy=_joined([cloud.points_xy for cloud in state.clouds], (0, 2)),
        normals_xy=_joined([cloud.normals_xy for cloud in state.clouds], (0, 2)),
        point_counts=[len(cloud) for cloud in state.clouds],
        ends_xy=_joined([beams.ends_xy for beams in state.beams], (0, 2)),
        marks=np.concatenate([np.zeros(0, dtype=bool), *(beams.marks for beams in state.beams)]),
        lasers_xy=np.array([beams.laser_xy for beams in state.beams]).reshape(-1, 2),
        beam_counts=[len(beams.marks) for beams in state.beams],
        poses=state.poses,
        base_in_map=state.base_in_map.as_array(),
        sessions=state.sessions,
        **{"edge_" + name: array for name, array in vars(state.edges).items()},
    )
    write_atomically(path, file.getvalue())


def load_state(path) -> MapState:
    """Read a file written by ``save_state``.

    Args:
        path: State file.

    Raises:
        StateFileError: The file cannot be read.
    """
    try:
        table = read_arrays(path)
    except FileNotFoundError:
        raise StateFileError(f"{path}: no such state file") from None
    except (OSError, ValueError) as error:
        raise StateFileError(f"{path}: not a readable state file ({error})") from None
    if str(table.get("format")) != FORMAT:
        raise StateFileError(f"{path}: not a state file of slam_lite")
    version = table.get("version", np.array(0))
    if version.shape != () or version != VERSION:
        raise StateFileError(
            f"{path}: version {version} of the format is not supported, only version {VERSION}"
        )
    table.setdefault("sessions", np.zeros(len(np.atleast_1d(table.get("poses", ()))), dtype=np.int64))
    problem = _problem_of(table)
    if problem:
        raise StateFileError(f"{path}: {problem}")
    points = _split(table["points_xy"], table["point_counts"])
    normals = _split(table["normals_xy"], table["point_counts"])
    ends = _split(table["ends_xy"], table["beam_counts"])
    marks = _split(table["marks"], table["beam_counts"])
    return MapState(
        [PointCloud(*pair) for pair in zip(points, normals)],
        [ScanBeams(*parts) for parts in zip(table["lasers_xy"], ends, marks)],
        table["poses"],
        Edges(*(table["edge_" + name] for name in ("nodes", "measured", "information", "is_loop"))),
        Pose2.from_array(table["base_in_map"]),
        table["sessions"],
    )


# The arrays of a file: numpy kinds, and shapes in which equal letters are equal lengths.
_LAYOUT = {
    "points_xy": ("f", "p2"),
    "normals_xy": ("f", "p2"),
    "point_counts": ("iuf", "k"),
    "ends_xy": ("f", "b2"),
    "marks": ("b", "b"),
    "lasers_xy": ("f", "k2"),
    "beam_counts": ("iuf", "k"),
    "poses": ("f", "k3"),
    "base_in_map": ("f", "3"),
    "sessions": ("iu", "k"),
    "edge_nodes": ("iu", "e2"),
    "edge_measured": ("f", "e3"),
    "edge_information": ("f", "e33"),
    "edge_is_loop": ("b", "e"),
}


def _problem_of(table: Mapping[str, np.ndarray]) -> str:
    """What is wrong with the arrays, for people; empty if they are a map."""
    lengths: Dict[str, int] = {}
    for name, (kinds, shape) in _LAYOUT.items():
        array = table.get(name)
        if array is None or array.dtype.kind not in kinds or array.ndim != len(shape):
            return f"{name} is missing, or has the wrong type or number of dimensions"
        for size, letter in zip(array.shape, shape):
            if size != (int(letter) if letter.isdigit() else lengths.setdefault(letter, size)):
                return f"{name} has the wrong shape {array.shape}"
        if name != "edge_information" and not (np.abs(array.astype(float)) <= MAX_COORDINATE).all():
            return f"{name} has values out of range"
    if not np.isfinite(table["edge_information"]).all():
        return "edge_information has values that are not finite"
    for counts, total in (("point_counts", "points_xy"), ("beam_counts", "ends_xy")):
        if (table[counts] < 0).any() or table[counts].sum() != len(table[total]):
            return f"{counts} does not add up to the length of {total}"
    nodes = table["edge_nodes"]
    if (nodes < 0).any() or (nodes >= len(table["poses"])).any():
        return "edge_nodes refers to a keyframe that does not exist"
    return ""


def _joined(parts: Sequence[np.ndarray], empty_shape) -> np.ndarray:
    return np.concatenate([np.empty(empty_shape, dtype=np.float32), *parts])


def _split(array: np.ndarray, counts: np.ndarray) -> List[np.ndarray]:
    return np.split(array, np.cumsum(counts.astype(int))[:-1]) if len(counts) else []
