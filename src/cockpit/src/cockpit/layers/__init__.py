"""What can be drawn in the world, one layer a module; a module that is put here is found."""

import importlib
import pkgutil
from typing import Dict, List

from cockpit.layer import DisplayLayer


def all_layers() -> List[DisplayLayer]:
    """Every layer, in the order of their titles."""
    modules = (
        importlib.import_module(f"{__name__}.{found.name}") for found in pkgutil.iter_modules(__path__)
    )
    return sorted((module.LAYER for module in modules), key=lambda layer: layer.title)


def by_type() -> Dict[str, DisplayLayer]:
    """The layer of each type of message."""
    return {kind: layer for layer in all_layers() for kind in layer.types}
