"""Resolves poses that are given relative to named frames (SDF 1.7 pose frame semantics)."""

from typing import Callable, Dict, Optional, Set, Tuple

import numpy as np

from sim_bridge.geometry.pose3 import IDENTITY, inverse
from sim_bridge.sdf.element import Element

ROOT_NAMES = ("", "__model__", "world")


class SdfFrames:
    """The named frames of a world or a model; its own frame is the root.

    The pose of a link, nested model or <frame> is given in the root unless it names another frame; that of a
    joint is given in its child.

    Args:
        frames_of: Returns the frames of a nested model, for names such as ``table::leg``.
    """

    def __init__(self, frames_of: Callable[[str], Optional["SdfFrames"]] = lambda _name: None):
        self._frames_of = frames_of
        self._declared: Dict[str, Tuple[Element, str, np.ndarray]] = {}
        # Poses in the root of declared frames that have been asked for: a link may have thousands of parts.
        self._poses: Dict[str, np.ndarray] = {}

    def declare(self, name: str, element: Element, parent: str = "", inside: np.ndarray = IDENTITY) -> None:
        """Declare a frame.

        Args:
            name: Name of the frame.
            element: Element with its <pose>.
            parent: Frame of the pose if the element names none.
            inside: Pose (4, 4), in the declared frame, of the frame that <pose> places.
        """
        self._declared[name] = (element, parent, inverse(inside))
        self._poses.clear()

    def pose_of(self, element: Element, parent: str = "") -> np.ndarray:
        """Return the pose (4, 4) of an element in the root.

        Args:
            element: Element with a <pose>.
            parent: Frame of the pose if the element names none.

        Raises:
            WorldError: A frame is unknown or depends on itself.
        """
        return self._placed(element, parent, set())

    def frame(self, name: str, referrer: Element) -> np.ndarray:
        """Return the pose (4, 4) of a frame in the root.

        Args:
            name: Name of the frame; ``nested::frame`` for one of a nested model.
            referrer: Element that refers to the frame, for errors.

        Raises:
            WorldError: The frame is unknown or depends on itself.
        """
        return self._frame(name, referrer, set())

    def _frame(self, name: str, referrer: Element, open_names: Set[str]) -> np.ndarray:
        if name in ROOT_NAMES:
            return IDENTITY
        if name in open_names:
            raise referrer.error(f"the pose of frame '{name}' depends on itself")
        if name in self._declared:
            if name not in self._poses:
                element, parent, inside = self._declared[name]
                self._poses[name] = self._placed(element, parent, open_names | {name}) @ inside
            return self._poses[name]
        outer, _, inner = name.partition("::")
        nested = self._frames_of(outer) if inner else None
        if nested is None or outer not in self._declared:
            raise referrer.error(f"there is no frame '{name}'")
        return self._frame(outer, referrer, open_names) @ nested.frame(inner, referrer)

    def _placed(self, element: Element, parent: str, open_names: Set[str]) -> np.ndarray:
        raw, in_frame = element.raw_pose(), _frame_named(element) or parent
        in_root = self._frame(in_frame, element, open_names)
        return in_root if raw is None else in_root @ raw


def _frame_named(element: Element) -> str:
    """Return the frame that an element's <pose> names: ``relative_to``, before SDF 1.7 ``frame``."""
    pose = element.child("pose")
    return "" if pose is None else pose.attribute("relative_to") or pose.attribute("frame")
