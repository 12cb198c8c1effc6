"""The commands behind the scripts, one a module; a module that is put here is found."""

import importlib
import pkgutil
from typing import List, Type

from home_service.command import Command


def names() -> List[str]:
    """The commands that there are."""
    return [module.name for module in pkgutil.iter_modules(__path__)]


def find(name: str) -> Type[Command]:
    """The command of that name; no other is imported."""
    module = importlib.import_module(f"{__name__}.{name}")
    return getattr(module, name.title().replace("_", ""))
