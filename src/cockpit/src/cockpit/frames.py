"""The tree of frames: current and recent transforms, and poses between any two frames."""

import math
from collections import deque
from dataclasses import dataclass
from typing import Any, Deque, Dict, List, Optional, Sequence, Tuple

import numpy as np

from sim_bridge.geometry.pose3 import quaternion

# A longer chain of parents is a loop.
DEEPEST = 64
# Two seconds at 50 Hz, for scans that arrive later than their transforms.
MOST_KEPT = 100


def pose_matrix(position: Sequence[float], quaternion: Sequence[float]) -> Optional[np.ndarray]:
    """Build a pose matrix.

    Args:
        position: x, y, z [m].
        quaternion: x, y, z, w of any length but zero.

    Returns:
        The pose (4, 4), or None if a number is not finite or the quaternion is zero.
    """
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
    """Return the rotation of a pose (4, 4) as the quaternion w, x, y, z of viser."""
    x, y, z, w = quaternion(pose)
    return w, x, y, z


def pose_from_message(position: Any, orientation: Any) -> Optional[np.ndarray]:
    """Convert a position and an orientation to a pose.

    Args:
        position: geometry_msgs Point or Vector3.
        orientation: geometry_msgs Quaternion.

    Returns:
        The pose (4, 4); None if it is invalid (see ``pose_matrix``).
    """
    p, q = position, orientation
    return pose_matrix((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))


def inverse(pose: np.ndarray) -> np.ndarray:
    """Invert a rigid pose (4, 4)."""
    turned = pose[:3, :3].T
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = turned, -turned @ pose[:3, 3]
    return result


@dataclass(frozen=True, eq=False)
class Transform:
    """A transform of a child frame.

    Attributes:
        parent: Parent frame.
        pose_in_parent: Pose of the child frame (4, 4).
        stamp: ROS time [s].
        is_static: Whether it was published on /tf_static.
        publisher: Name of the publishing node.
    """

    parent: str
    pose_in_parent: np.ndarray
    stamp: float
    is_static: bool
    publisher: str = ""


class FrameTree:
    """The newest and the last few transforms of each frame."""

    def __init__(self):
        self._transforms: Dict[str, Transform] = {}
        self._past: Dict[str, Deque[Transform]] = {}

    def put(self, child: str, transform: Transform) -> None:
        """Store a transform.

        Args:
            child: Child frame.
            transform: Its pose in the parent frame; older transforms are dropped when its stamp jumps back.
        """
        child = child.lstrip("/")
        past = self._past.setdefault(child, deque(maxlen=MOST_KEPT))
        if past and transform.stamp < past[-1].stamp:  # time has jumped back
            past.clear()
        past.append(transform)
        self._transforms[child] = transform

    def clear(self) -> None:
        self._transforms.clear()
        self._past.clear()

    def reset(self) -> None:
        """Drop all transforms that are not static, after ROS time has jumped back."""
        for child in [child for child, newest in self._transforms.items() if not newest.is_static]:
            del self._transforms[child]
            del self._past[child]

    def transforms(self) -> Dict[str, Transform]:
        """Return the newest transform of each child frame."""
        return dict(self._transforms)

    def names(self) -> List[str]:
        parents = {transform.parent for transform in self._transforms.values()}
        return sorted(parents | set(self._transforms))

    def roots(self) -> List[str]:
        """Return the frames without a parent."""
        return [name for name in self.names() if name not in self._transforms]

    def pose(self, frame: str, fixed: str, at: Optional[float] = None) -> Optional[np.ndarray]:
        """Look up the pose of a frame in another one.

        Args:
            frame: Frame whose pose is wanted.
            fixed: Reference frame.
            at: ROS time [s]; the stored transform closest to it is used. None for the newest.

        Returns:
            The pose (4, 4), or None if the frames are not connected.
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
            transform = self._transform(frame, at)
            if transform is None:
                break
            pose, frame = transform.pose_in_parent @ pose, transform.parent
        return frame, pose

    def _transform(self, frame: str, at: Optional[float]) -> Optional[Transform]:
        if at is None or frame not in self._past:
            return self._transforms.get(frame)
        return min(self._past[frame], key=lambda transform: abs(transform.stamp - at))
