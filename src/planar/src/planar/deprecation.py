"""Old names of public classes and functions, kept as aliases that warn."""

import importlib
import warnings
from typing import Any, Callable, Dict


def deprecated_names(module: str, renamed: Dict[str, str]) -> Callable[[str], Any]:
    """Make the ``__getattr__`` of a module (PEP 562) that resolves old names to their replacements.

    Use it as ``__getattr__ = deprecated_names(__name__, {"Sighting": "Observation"})``.

    Args:
        module: Name of the module that had the old names.
        renamed: Each old name with its replacement: a name in the same module, or ``"package.module:name"``.

    Returns:
        A function that takes an attribute's name, emits a DeprecationWarning and returns the replacement.

    Raises:
        AttributeError: From the returned function, for a name that is not in ``renamed``.
    """

    def resolve(name: str) -> Any:
        if name not in renamed:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        place, _, new = renamed[name].rpartition(":")
        place = place or module
        warnings.warn(f"{module}.{name} is deprecated; use {place}.{new}", DeprecationWarning, stacklevel=2)
        return getattr(importlib.import_module(place), new)

    return resolve


def renamed_method(old: str, new: str) -> Callable[..., Any]:
    """Make a method that keeps an old name working: it emits a DeprecationWarning and calls the new one.

    Use it in the body of a class as ``tell = renamed_method("tell", "notify")``.
    """

    def call(self: Any, *arguments: Any, **keywords: Any) -> Any:
        warnings.warn(
            f"{type(self).__name__}.{old} is deprecated; use {new}", DeprecationWarning, stacklevel=2
        )
        return getattr(self, new)(*arguments, **keywords)

    return call
