"""The tree of frames as a table: who tells each transform, how old it is (rqt_tf_tree)."""

from typing import Dict, Iterator, List, Mapping, Tuple

from cockpit.frames import Transform

HEADS = ("Frame", "Age (s)", "Hz", "Told by")
Row = Tuple[str, str, str, str]


def rows_of(transforms: Mapping[str, Transform], now: float, rates: Mapping[str, float]) -> List[Row]:
    """From the roots down. ``now``: seconds of ROS time; ``rates``: transforms a second of each frame."""
    children: Dict[str, List[str]] = {}
    for frame, transform in sorted(transforms.items()):
        children.setdefault(transform.parent, []).append(frame)
    roots = sorted(set(children) - set(transforms))
    seen: List[str] = []
    found = [row for root in roots for row in _below(root, 0, transforms, children, now, rates, seen)]
    looped = sorted(set(transforms) - set(seen))
    return found + [
        _row(f"{frame} (in a loop)", transforms[frame], now, rates.get(frame)) for frame in looped
    ]


def _below(frame, depth, transforms, children, now, rates, seen) -> Iterator[Row]:
    seen.append(frame)
    name = "\u00a0\u00a0\u00a0" * depth + frame
    told = transforms.get(frame)
    yield (name, "", "", "") if told is None else _row(name, told, now, rates.get(frame))
    for child in children.get(frame, ()):
        yield from _below(child, depth + 1, transforms, children, now, rates, seen)


def _row(name: str, told: Transform, now: float, rate) -> Row:
    if told.is_static:
        return name, "static", "", told.told_by
    return name, f"{now - told.stamp:.2f}", "" if rate is None else f"{rate:.1f}", told.told_by
