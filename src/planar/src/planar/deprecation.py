"""Old names of public classes, functions and fields, kept as aliases that warn."""

import functools
import importlib
import warnings
from typing import Any, Callable, Dict, TypeVar

C = TypeVar("C", bound=type)


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


def renamed_fields(**renamed: str) -> Callable[[C], C]:
    """Decorate a class whose fields have new names so that the old ones are still read and passed.

    Use it above ``@dataclass`` as ``@renamed_fields(movers="dynamic_obstacles")``. An old name works as an
    attribute, as a keyword of the constructor and in ``dataclasses.replace``, with a DeprecationWarning.

    Args:
        renamed: Each old name with its replacement.
    """

    def decorate(cls: C) -> C:
        construct: Callable[..., None] = cls.__init__  # type: ignore[misc]

        @functools.wraps(construct)
        def construct_with_old_names(self: Any, *arguments: Any, **keywords: Any) -> None:
            for old in renamed.keys() & keywords.keys():
                _warn_of_field(cls, old, renamed[old])
                keywords[renamed[old]] = keywords.pop(old)
            construct(self, *arguments, **keywords)

        cls.__init__ = construct_with_old_names  # type: ignore[misc]
        for old, new in renamed.items():
            setattr(cls, old, _renamed_field(old, new))
        return cls

    return decorate


def _renamed_field(old: str, new: str) -> property:
    def read(self: Any) -> Any:
        _warn_of_field(type(self), old, new)
        return getattr(self, new)

    return property(read, doc=f"Deprecated name of ``{new}``.")


def _warn_of_field(cls: type, old: str, new: str) -> None:
    warnings.warn(f"{cls.__name__}.{old} is deprecated; use {new}", DeprecationWarning, stacklevel=3)
