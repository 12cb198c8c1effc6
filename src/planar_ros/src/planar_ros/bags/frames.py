"""The frames of a bag: which one is the robot's base, and in which one odometry moves it."""

import contextlib
from dataclasses import dataclass
from typing import Any, Callable, Dict, Iterable, Iterator, List, Protocol, Sequence, Set, Tuple

from planar_ros.bags.bag_reader import TF, TF_STATIC, BagError, RecordedMessage
from planar_ros.bags.transform_log import is_same, typed
from planar_ros.messages.conversion import frame_name

# Names of a base by REP 105 and of the TurtleBot.
_BASE_NAMES = ("base_link", "base_footprint")
_MAP_FRAME = "map"
Edge = Tuple[str, str]


class MessageSource(Protocol):
    """A bag or a recording of several bags."""

    def messages(self, topics: Iterable[str]) -> Iterator[RecordedMessage]:
        """Iterate over the messages of some topics in recorded order."""
        ...


@dataclass(frozen=True)
class BagFrames:
    """Frames of a bag.

    Attributes:
        odom: Frame of odometry.
        base: Frame of the robot's base.
        has_odometry: Whether the pose of ``base`` in ``odom`` was recorded.
        substitution: Which frames stand for those asked for and why, for messages to people; empty if they
            are those asked for.
    """

    odom: str
    base: str
    has_odometry: bool
    substitution: str = ""


class TransformTree:
    """Transforms of a bag as a tree: the parent and the first transform of each frame, and which ones move.

    Attributes:
        first: First transform of each frame, by its name.
    """

    def __init__(self) -> None:
        self.first: Dict[str, Any] = {}
        self._moving: Set[str] = set()

    def add(self, message) -> None:
        """Add the transforms of a tf2_msgs/TFMessage."""
        for transform in map(typed, message.transforms):
            known = self.first.setdefault(transform.child_frame_id, transform)
            if transform.child_frame_id not in self._moving and not is_same(known, transform):
                self._moving.add(transform.child_frame_id)

    @property
    def frames(self) -> Set[str]:
        """Names of all frames."""
        return set(self.first).union(each.header.frame_id for each in self.first.values())

    def frames_from(self, frame: str) -> List[str]:
        """Return a frame and all frames above it, from the bottom."""
        above = [frame]
        while above[-1] in self.first and self.first[above[-1]].header.frame_id not in above:
            above.append(self.first[above[-1]].header.frame_id)
        return above

    def moving_edges(self) -> List[Edge]:
        """Return parent and child of each transform that changes, except those below the map."""
        edges = [(self.first[child].header.frame_id, child) for child in sorted(self._moving)]
        return [edge for edge in edges if edge[0] != _MAP_FRAME]


def read_tree(
    source: MessageSource,
    topics: Sequence[str],
    is_enough: Callable[[TransformTree], bool] = lambda tree: False,
) -> TransformTree:
    """Read the transforms of a bag until there are enough; a broken bag up to its broken part.

    Args:
        source: The bag.
        topics: /tf, /tf_static or both.
        is_enough: Called after each message; reading ends when it returns True.

    Returns:
        The transforms read.
    """
    tree = TransformTree()
    with contextlib.suppress(BagError):  # raised again when the messages are read up to the broken part
        for played in source.messages(topics):
            tree.add(played.message)
            if is_enough(tree):
                break
    return tree


def find_frames(source: MessageSource, odom: str, base: str, laser: str) -> BagFrames:
    """Find the frames of odometry and base; those asked for if the bag has a transform between them.

    Otherwise the one frame that moves in another one is the base.

    Args:
        source: The bag.
        odom: Frame of odometry asked for.
        base: Frame of the base asked for.
        laser: Frame of the scans.

    Raises:
        BagError: Several frames move and none is more likely to be the base; the text lists them.
    """
    odom, base, laser = map(frame_name, (odom, base, laser))
    tree = read_tree(source, [TF_STATIC, TF], lambda read: odom in read.frames_from(base)[1:])
    if odom in tree.frames_from(base)[1:]:
        return BagFrames(odom, base, True)
    candidates = _candidates(tree, odom, base, laser)
    if not candidates:
        return _frames_at_rest(tree, odom, base, laser)
    if len(candidates) > 1:
        found = ", ".join(f"{parent} -> {child}" for parent, child in candidates)
        raise BagError(
            f"no transform {odom} -> {base}, and several frames move: {found}; set the frames of odometry "
            "and of the base"
        )
    parent, child = candidates[0]
    found_base = base if child in tree.frames_from(base) else child
    reason = f"odometry is {parent} -> {found_base}, as no transform {odom} -> {base} was recorded"
    return BagFrames(parent, found_base, True, reason)


def _frames_at_rest(tree: TransformTree, odom: str, base: str, laser: str) -> BagFrames:
    """Frames of a bag in which nothing moves: the base asked for, or the frame on which the laser is."""
    above_laser = [frame for frame in tree.frames_from(laser)[1:] if frame not in (odom, _MAP_FRAME)]
    if base in tree.frames or not above_laser:
        return BagFrames(odom, base, False)
    found = next((frame for frame in above_laser if frame in _BASE_NAMES), above_laser[-1])
    reason = f"the base is {found}, as the bag has no frame {base}"
    return BagFrames(odom, found, odom in tree.frames_from(found), reason)


def _candidates(tree: TransformTree, odom: str, base: str, laser: str) -> List[Edge]:
    """Edges that may be odometry: of the first of these criteria that any edge meets."""
    moving = tree.moving_edges()
    moving_parents = {child for _, child in moving}
    criteria: Sequence[Callable[[str, str], bool]] = (
        lambda parent, child: parent == odom,
        lambda parent, child: child in tree.frames_from(base),
        lambda parent, child: child in tree.frames_from(laser),
        lambda parent, child: child in _BASE_NAMES,
        lambda parent, child: True,
    )
    # A joint of the robot is below a frame that moves itself, or below the base.
    outermost = [edge for edge in moving if edge[0] not in moving_parents and edge[0] not in (base, laser)]
    for meets in criteria:
        found = [edge for edge in outermost if meets(*edge)]
        if len(found) > 1:
            found = [edge for edge in found if edge[1] in tree.frames_from(laser)] or found
        if len(found) > 1:
            found = [edge for edge in found if edge[1] in _BASE_NAMES] or found
        if found:
            return found
    return []
