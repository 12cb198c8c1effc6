"""Where frames are and were a moment ago, and ways between any two."""

import math
from collections import deque
from dataclasses import dataclass
from typing import Any, Deque, Dict, List, Optional, Sequence, Tuple

import numpy as np

from sim_bridge.geometry.pose3 import quaternion

# Longer chains are a loop.
DEEPEST = 64
# Two seconds of what comes fifty times a second: for scans that come later than their transforms.
MOST_KEPT = 100


def pose_matrix(position: Sequence[float], quaternion: Sequence[float]) -> Optional[np.ndarray]:
    """A pose as (4, 4) of metres and a quaternion (x, y, z, w) of any length but zero; None if it is none."""
    x, y, z, w = quaternion
    length = x * x + y * y + z * z + w * w
    if not (all(map(math.isfinite, position)) and 1e-6 < length < 1e6):
        return None
    s = 2.0 / length
    return np.array(
        [
            [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w), position[0]],
            [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w), position[1]],
            [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y), position[2]],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def wxyz_of(pose: np.ndarray) -> Tuple[float, float, float, float]:
    """The rotation of a pose (4, 4) as viser takes it: w, x, y, z."""
    x, y, z, w = quaternion(pose)
    return w, x, y, z


def pose_from_message(position: Any, orientation: Any) -> Optional[np.ndarray]:
    """The same as messages of geometry_msgs tell it: of a Point or Vector3, and a Quaternion."""
    p, q = position, orientation
    return pose_matrix((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))


def inverse(pose: np.ndarray) -> np.ndarray:
    """Of a rigid pose (4, 4)."""
    turned = pose[:3, :3].T
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = turned, -turned @ pose[:3, 3]
    return result


@dataclass(frozen=True, eq=False)
class Transform:
    """``pose_in_parent``: (4, 4); ``stamp``: seconds of ROS time; ``is_static``: from /tf_static."""

    parent: str
    pose_in_parent: np.ndarray
    stamp: float
    is_static: bool
    publisher: str = ""


class FrameTree:
    """The newest transform of each frame, and the last few: a view needs no more."""

    def __init__(self):
        self._transforms: Dict[str, Transform] = {}
        self._past: Dict[str, Deque[Transform]] = {}

    def put(self, child: str, transform: Transform) -> None:
        child = child.lstrip("/")
        past = self._past.setdefault(child, deque(maxlen=MOST_KEPT))
        if past and transform.stamp < past[-1].stamp:  # time began anew
            past.clear()
        past.append(transform)
        self._transforms[child] = transform

    def clear(self) -> None:
        self._transforms.clear()
        self._past.clear()

    def reset(self) -> None:
        """Time has: what moves is nowhere until it is told again."""
        for child in [child for child, told in self._transforms.items() if not told.is_static]:
            del self._transforms[child]
            del self._past[child]

    def transforms(self) -> Dict[str, Transform]:
        """That of each frame that has a parent."""
        return dict(self._transforms)

    def names(self) -> List[str]:
        parents = {transform.parent for transform in self._transforms.values()}
        return sorted(parents | set(self._transforms))

    def roots(self) -> List[str]:
        return [name for name in self.names() if name not in self._transforms]

    def pose(self, frame: str, fixed: str, at: Optional[float] = None) -> Optional[np.ndarray]:
        """Of ``frame`` in ``fixed``, (4, 4); None if no chain of transforms leads from one to the other.

        ``at``: seconds of ROS time, of which what is kept comes nearest; None: now.
        """
        frame, fixed = frame.lstrip("/"), fixed.lstrip("/")
        if frame == fixed:
            return np.eye(4)
        frame_root, frame_in_root = self._to_root(frame, at)
        fixed_root, fixed_in_root = self._to_root(fixed, at)
        return inverse(fixed_in_root) @ frame_in_root if frame_root == fixed_root else None

    def _to_root(self, frame: str, at: Optional[float]) -> Tuple[str, np.ndarray]:
        pose = np.eye(4)
        for _ in range(DEEPEST):
            transform = self._told(frame, at)
            if transform is None:
                break
            pose, frame = transform.pose_in_parent @ pose, transform.parent
        return frame, pose

    def _told(self, frame: str, at: Optional[float]) -> Optional[Transform]:
        if at is None or frame not in self._past:
            return self._transforms.get(frame)
        return min(self._past[frame], key=lambda transform: abs(transform.stamp - at))
