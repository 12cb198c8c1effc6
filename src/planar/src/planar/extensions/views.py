"""Read-only views of what is given to a plugin."""

from dataclasses import fields, is_dataclass
from typing import Any, Dict

import numpy as np

# Whether values of a type hold no arrays, by type.
_HOLDS_NO_ARRAY: Dict[type, bool] = {
    each: True for each in (float, int, bool, str, tuple, list, dict, type(None))
}
_PLAIN_FIELDS = {each for kind in (float, int, bool, str) for each in (kind, kind.__name__)}


def read_only(value: Any, depth: int = 2) -> Any:
    """Return a value whose arrays cannot be written to; nothing is copied but the objects that hold them.

    Args:
        value: An array, or an object with arrays among its attributes.
        depth: How far attributes of attributes are followed.

    Returns:
        A view of an array; a shallow copy of an object with arrays; else the value itself.
    """
    kind = type(value)
    if kind is np.ndarray:
        return _view(value)
    holds_none = _HOLDS_NO_ARRAY.get(kind)
    if holds_none is None:
        holds_none = _HOLDS_NO_ARRAY[kind] = _holds_no_array(value)
    if holds_none:
        return value
    views = {}
    for name, attribute in value.__dict__.items():
        if type(attribute) is np.ndarray:
            views[name] = _view(attribute)
        elif depth > 1 and not _HOLDS_NO_ARRAY.get(type(attribute)):
            view = read_only(attribute, depth - 1)
            if view is not attribute:
                views[name] = view
    if not views:
        return value
    copied = object.__new__(kind)
    copied.__dict__.update(value.__dict__)
    copied.__dict__.update(views)
    return copied


def _view(array: np.ndarray) -> np.ndarray:
    view = array.view()
    view.setflags(write=False)
    return view


def _holds_no_array(value: Any) -> bool:
    """Whether no value of this type can hold an array: callables, and dataclasses of numbers and texts."""
    if callable(value) or not hasattr(value, "__dict__"):
        return True
    return is_dataclass(value) and all(field.type in _PLAIN_FIELDS for field in fields(value))
