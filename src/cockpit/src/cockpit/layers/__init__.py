"""Layers of the 3D view: each module of this package contains one, and all modules are loaded."""

import importlib
import pkgutil
from typing import Dict, List

from cockpit.layer import DisplayLayer


def all_layers() -> List[DisplayLayer]:
    """Return all layers sorted by title."""
    modules = (
        importlib.import_module(f"{__name__}.{found.name}") for found in pkgutil.iter_modules(__path__)
    )
    return sorted((module.LAYER for module in modules), key=lambda layer: layer.title)


def by_type() -> Dict[str, DisplayLayer]:
    """Return the layer of each message type."""
    return {kind: layer for layer in all_layers() for kind in layer.types}
