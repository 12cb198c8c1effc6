"""Read-only views of what is given to a plugin."""

from typing import Any

import numpy as np


def read_only(value: Any, depth: int = 2) -> Any:
    """Return a value whose arrays cannot be written to; nothing is copied but the objects that hold them.

    Args:
        value: An array, or an object with arrays among its attributes.
        depth: How far attributes of attributes are followed.

    Returns:
        A view of an array; a shallow copy of an object with arrays; else the value itself.
    """
    if isinstance(value, np.ndarray):
        view = value.view()
        view.flags.writeable = False
        return view
    attributes = getattr(value, "__dict__", None)
    if not (depth and attributes) or callable(value):
        return value
    views = {}
    for name, attribute in attributes.items():
        if type(attribute) not in _PLAIN:
            view = read_only(attribute, depth - 1)
            if view is not attribute:
                views[name] = view
    if not views:
        return value
    copied = object.__new__(type(value))
    copied.__dict__.update(attributes, **views)
    return copied


_PLAIN = frozenset({float, int, bool, str, tuple, list, dict, type(None)})
