"""Public names of a package that are imported when they are first used."""

import sys
from importlib import import_module
from typing import Any, Callable, Mapping, Optional, Sequence


def lazy_names(
    package: str, modules: Mapping[str, Sequence[str]], other: Optional[Callable[[str], Any]] = None
) -> Callable[[str], Any]:
    """Make the ``__getattr__`` of a package (PEP 562): who needs one name does not load the others.

    Use it as ``__getattr__ = lazy_names(__name__, {"planar.errors": ("PlanarError",)})``.

    Args:
        package: Name of the package.
        modules: Public names by the module that has them.
        other: Resolves all other names, such as deprecated ones.

    Returns:
        A function that takes an attribute's name and returns the attribute.

    Raises:
        AttributeError: From the returned function, for an unknown name.
    """
    module_of = {name: module for module, names in modules.items() for name in names}

    def resolve(name: str) -> Any:
        if name in module_of:
            found = getattr(import_module(module_of[name]), name)
            setattr(sys.modules[package], name, found)
            return found
        if other is not None:
            return other(name)
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    return resolve
