"""Poses by the names of the frames they are given in (SDF 1.7 pose frame semantics)."""

from typing import Callable, Dict, Optional, Set, Tuple

import numpy as np

from sim_bridge.geometry.pose3 import IDENTITY, inverse
from sim_bridge.sdf.element import Element

ROOT_NAMES = ("", "__model__", "world")


class SdfFrames:
    """The named frames of a world, or of a model; poses are told in its own frame, the root.

    The pose of a link, nested model or <frame> is given in the root unless it names another frame, that of a
    joint in its child. ``frames_of`` finds the frames of a model nested here, for names like ``table::leg``.
    """

    def __init__(self, frames_of: Callable[[str], Optional["SdfFrames"]] = lambda _name: None):
        self._frames_of = frames_of
        self._declared: Dict[str, Tuple[Element, str, np.ndarray]] = {}

    def declare(self, name: str, element: Element, parent: str = "", inside: np.ndarray = IDENTITY) -> None:
        """A frame whose pose ``element`` holds; ``parent`` is what it is given in if it does not say so.

        ``inside``: (4, 4), what the pose places, seen from the frame declared.
        """
        self._declared[name] = (element, parent, inverse(inside))

    def pose_of(self, element: Element, parent: str = "") -> np.ndarray:
        """Of what ``element`` describes, (4, 4) in the root. Raises WorldError for an unknown frame."""
        return self._placed(element, parent, set())

    def frame(self, name: str, seen_from: Element) -> np.ndarray:
        """The pose (4, 4) in the root of a frame by its name. Raises WorldError naming ``seen_from``."""
        return self._frame(name, seen_from, set())

    def _frame(self, name: str, seen_from: Element, open_names: Set[str]) -> np.ndarray:
        if name in ROOT_NAMES:
            return IDENTITY
        if name in open_names:
            raise seen_from.error(f"the pose of frame '{name}' depends on itself")
        if name in self._declared:
            element, parent, inside = self._declared[name]
            return self._placed(element, parent, open_names | {name}) @ inside
        outer, _, inner = name.partition("::")
        nested = self._frames_of(outer) if inner else None
        if nested is None or outer not in self._declared:
            raise seen_from.error(f"there is no frame '{name}'")
        return self._frame(outer, seen_from, open_names) @ nested.frame(inner, seen_from)

    def _placed(self, element: Element, parent: str, open_names: Set[str]) -> np.ndarray:
        raw, in_frame = element.raw_pose(), _frame_named(element) or parent
        in_root = self._frame(in_frame, element, open_names)
        return in_root if raw is None else in_root @ raw


def _frame_named(element: Element) -> str:
    """The frame that an element's <pose> says it is given in: ``relative_to``, before SDF 1.7 ``frame``."""
    pose = element.child("pose")
    return "" if pose is None else pose.attribute("relative_to") or pose.attribute("frame")
