"""The tree of frames as a table: publisher and age of each transform (rqt_tf_tree)."""

from typing import Dict, Iterator, List, Mapping, Tuple

from cockpit.frames import Transform

HEADS = ("Frame", "Age (s)", "Hz", "Publisher")
Row = Tuple[str, str, str, str]


def rows_of(transforms: Mapping[str, Transform], now: float, rates: Mapping[str, float]) -> List[Row]:
    """List the frames from the roots down.

    Args:
        transforms: Newest transform of each child frame.
        now: ROS time [s].
        rates: Transforms per second of each child frame.
    """
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
    transform = transforms.get(frame)
    yield (name, "", "", "") if transform is None else _row(name, transform, now, rates.get(frame))
    for child in children.get(frame, ()):
        yield from _below(child, depth + 1, transforms, children, now, rates, seen)


def _row(name: str, transform: Transform, now: float, rate) -> Row:
    if transform.is_static:
        return name, "static", "", transform.publisher
    return name, f"{now - transform.stamp:.2f}", "" if rate is None else f"{rate:.1f}", transform.publisher
