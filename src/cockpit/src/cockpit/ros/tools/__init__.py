"""The tools, one a module; a module that is put here is found."""

import importlib
import pkgutil
from typing import Dict, List, Type

from cockpit.ros.tool import Tool


def names() -> List[str]:
    """The modules that hold tools; a tool has the name of its module."""
    return sorted(found.name for found in pkgutil.iter_modules(__path__))


def all_tools() -> Dict[str, Type[Tool]]:
    """Every tool by its name."""
    return {name: importlib.import_module(f"{__name__}.{name}").TOOL for name in names()}
