"""Where frames are: the latest transform of each, and ways between any two."""

from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

# Longer chains are a loop.
DEEPEST = 64


def pose_matrix(position: Sequence[float], quaternion: Sequence[float]) -> Optional[np.ndarray]:
    """A pose as (4, 4) of metres and a quaternion (x, y, z, w) of any length but zero; None if it is none."""
    x, y, z, w = quaternion
    length = x * x + y * y + z * z + w * w
    matrix = np.eye(4)
    matrix[:3, 3] = position
    if not (np.isfinite(matrix[:3, 3]).all() and 1e-6 < length < 1e6):
        return None
    s = 2.0 / length
    matrix[:3, :3] = [
        [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)],
    ]
    return matrix


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
    told_by: str = ""


class FrameTree:
    """The newest transform of each frame; unlike tf2's buffer it keeps no history, which a view needs not."""

    def __init__(self):
        self._transforms: Dict[str, Transform] = {}

    def put(self, child: str, transform: Transform) -> None:
        self._transforms[child.lstrip("/")] = transform

    def clear(self) -> None:
        self._transforms.clear()

    def transforms(self) -> Dict[str, Transform]:
        """That of each frame that has a parent."""
        return dict(self._transforms)

    def names(self) -> List[str]:
        parents = {transform.parent for transform in self._transforms.values()}
        return sorted(parents | set(self._transforms))

    def roots(self) -> List[str]:
        return [name for name in self.names() if name not in self._transforms]

    def pose(self, frame: str, fixed: str) -> Optional[np.ndarray]:
        """Of ``frame`` in ``fixed``, (4, 4); None if no chain of transforms leads from one to the other."""
        frame, fixed = frame.lstrip("/"), fixed.lstrip("/")
        if frame == fixed:
            return np.eye(4)
        frame_root, frame_in_root = self._to_root(frame)
        fixed_root, fixed_in_root = self._to_root(fixed)
        return inverse(fixed_in_root) @ frame_in_root if frame_root == fixed_root else None

    def _to_root(self, frame: str) -> Tuple[str, np.ndarray]:
        pose = np.eye(4)
        for _ in range(DEEPEST):
            transform = self._transforms.get(frame)
            if transform is None:
                break
            pose, frame = transform.pose_in_parent @ pose, transform.parent
        return frame, pose
