"""The tools, one a module; every module of this package is loaded."""

import importlib
import pkgutil
from typing import Dict, List, Type

from cockpit.ros.tool import Tool


def names() -> List[str]:
    """Return the names of the tools, which are those of their modules."""
    return sorted(found.name for found in pkgutil.iter_modules(__path__))


def all_tools() -> Dict[str, Type[Tool]]:
    """Return all tools by name."""
    return {name: importlib.import_module(f"{__name__}.{name}").TOOL for name in names()}
