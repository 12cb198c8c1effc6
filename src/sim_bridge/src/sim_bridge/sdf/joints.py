"""Reads <joint> elements."""

from dataclasses import replace
from typing import Callable, Dict, List, Optional, Sequence

import numpy as np

from sim_bridge.geometry.pose3 import inverse
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.frames import SdfFrames
from sim_bridge.sdf.models import SdfModel
from sim_bridge.sdf.warnings import SkippedElements
from sim_bridge.world import Joint

KINDS = ("fixed", "revolute", "prismatic")


def read_joint(
    joint: Element, model: SdfModel, name: str, links: Dict[str, np.ndarray], warnings: SkippedElements
) -> Joint:
    """Read a joint.

    Args:
        joint: The element.
        model: The model that it belongs to.
        name: Full name of the model.
        links: Pose (4, 4) in the model of each link, by name.
        warnings: Receives a warning if the type is not supported; the joint is fixed then.

    Raises:
        WorldError: A value is not valid or a link does not exist.
    """
    kind = joint.attribute("type")
    parent, child = (_link_named(joint, end, links) for end in ("parent", "child"))
    if not child:
        raise joint.error("the child must be a link of the model, not the world")
    if kind not in KINDS:
        warnings.skip(joint, f"joint type {kind!r} is not supported, treated as fixed", kind=("joint", kind))
        kind = "fixed"
    in_model = model.frames.pose_of(joint, child)
    full = _Scope(name)
    axis = joint.child("axis")
    if axis is not None and kind == "fixed":
        axis.mark_all()  # without effect in Gazebo, too
    fixed = Joint(
        full.joint(joint.name),
        "fixed",
        full.link(parent),
        full.link(child),
        inverse(links[child]) @ in_model,
        np.array([0.0, 0.0, 1.0]),
    )
    return fixed if kind == "fixed" or axis is None else _moving(fixed, kind, axis, in_model, model.frames)


class _Scope:
    """Full names of the joints and links of a model."""

    def __init__(self, name: str):
        self._name = name

    def joint(self, name: str) -> str:
        return f"{self._name}::{name}"

    def link(self, name: str) -> str:
        return f"{self._name}::{name}" if name else ""


def _link_named(joint: Element, end: str, links: Dict[str, np.ndarray]) -> str:
    """Return the name of a joint's parent or child; empty for the world."""
    element = joint.required(end)
    if element.text == "world":
        return ""
    if element.text not in links:
        raise element.error(f"there is no link '{element.text}'")
    return element.text


def _moving(fixed: Joint, kind: str, axis: Element, in_model: np.ndarray, frames: SdfFrames) -> Joint:
    lower = axis.bound("limit", "lower", default=-np.inf)
    upper = axis.bound("limit", "upper", default=np.inf)
    if lower > upper:
        raise axis.error(f"the lower limit {lower:g} is above the upper one {upper:g}")
    effort = axis.bound("limit", "effort", default=-1.0)
    return Joint(
        fixed.name,
        kind,
        fixed.parent,
        fixed.child,
        fixed.pose_in_child,
        _direction(axis, in_model, frames),
        lower,
        upper,
        effort if effort >= 0.0 else np.inf,
        max(axis.number("dynamics", "damping", default=0.0), 0.0),
        max(axis.number("dynamics", "friction", default=0.0), 0.0),
    )


def _direction(axis: Element, in_model: np.ndarray, frames: SdfFrames) -> np.ndarray:
    """Return the axis (3,) in the joint frame; before SDF 1.5 it is given in the model frame."""
    xyz = axis.child("xyz")
    direction = np.array(xyz.numbers(3) if xyz is not None else (0.0, 0.0, 1.0))
    length = np.linalg.norm(direction)
    if length == 0.0:
        raise axis.error("an axis needs a direction, got 0 0 0")
    expressed_in = xyz.attribute("expressed_in") if xyz is not None else ""
    frame: Optional[np.ndarray] = None
    is_in_model = axis.flag("use_parent_model_frame")
    if expressed_in:
        frame = frames.frame(expressed_in, axis)
    elif is_in_model or axis.version < (1, 5):
        frame = np.eye(4)
    if frame is not None:
        direction = in_model[:3, :3].T @ frame[:3, :3] @ direction
    return direction / length


def with_start_position(joint: Joint, before: np.ndarray, now: np.ndarray) -> Joint:
    """Return a joint with the start position that follows from the present pose of its child.

    Args:
        joint: The joint.
        before: Pose (4, 4) of the child in the parent at position 0.
        now: Pose (4, 4) of the child in the parent at the start.
    """
    moved = inverse(before @ joint.pose_in_child) @ now @ joint.pose_in_child
    if joint.kind == "prismatic":
        return replace(joint, start=float(moved[:3, 3] @ joint.axis))
    skew = moved[:3, :3] - moved[:3, :3].T
    sine = np.array([skew[2, 1], skew[0, 2], skew[1, 0]]) @ joint.axis / 2.0
    return replace(joint, start=float(np.arctan2(sine, (np.trace(moved[:3, :3]) - 1.0) / 2.0)))


def without_loops(joints: Sequence[Joint], warn: Callable[[Joint], None]) -> List[Joint]:
    """Return the joints that form trees; call ``warn`` for each one that closes a loop."""
    parents: Dict[str, str] = {}
    kept = []
    for joint in joints:
        above = joint.parent
        while above and above != joint.child:
            above = parents.get(above, "")
        if joint.child in parents or above == joint.child:
            warn(joint)
            continue
        parents[joint.child] = joint.parent
        kept.append(joint)
    return kept
