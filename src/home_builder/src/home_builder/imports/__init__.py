"""Importers: each makes a plan of a kind of file."""

import importlib
from pathlib import Path
from typing import Callable, Optional

from home_builder.errors import ImportPlanError
from home_builder.plan.model import HomePlan
from planar.files.reading import exists

PICTURES = (".png", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff", ".pgm", ".webp")
WORLDS = (".world", ".sdf")
MAPS = (".yaml", ".yml")
DRAWINGS = (".dxf", ".ifc")
SUFFIXES = (*MAPS, *PICTURES, *WORLDS, *DRAWINGS)


def import_plan(path: Path, scale: Optional[float] = None) -> HomePlan:
    """Make a plan of a file; its suffix names the kind.

    Args:
        path: Map (YAML), picture of a floor plan, DXF, IFC or SDF file.
        scale: Size of a pixel of a picture, or of a unit of a DXF file [m].

    Raises:
        PlanarError: The file cannot be read or shows no plan; the text names it.
    """
    suffix = path.suffix.lower()
    if not exists(path):
        raise ImportPlanError(f"{path}: no such file")
    if suffix in PICTURES:
        if scale is None:
            raise ImportPlanError(f"{path}: a picture needs --scale, the size of a pixel in metres")
        return _importer("pictures", "import_picture")(path, scale)
    if suffix == ".dxf":
        return _importer("dxf", "import_dxf")(path, scale)
    if scale is not None:
        raise ImportPlanError(f"{path}: --scale is for pictures and DXF files; this file has its own")
    importers = {
        **dict.fromkeys(MAPS, ("maps", "import_map")),
        **dict.fromkeys(WORLDS, ("worlds", "import_world")),
    }
    importers[".ifc"] = ("ifc", "import_ifc")
    if suffix not in importers:
        raise ImportPlanError(f"{path}: unknown kind of file; expected one of {', '.join(SUFFIXES)}")
    return _importer(*importers[suffix])(path)


def _importer(module: str, name: str) -> Callable[..., HomePlan]:
    """Import an importer when it is used, since each needs libraries that others do not."""
    try:
        return getattr(importlib.import_module(f"home_builder.imports.{module}"), name)
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] in ("ezdxf", "ifcopenshell"):
            raise ImportPlanError(
                f"{error.name} is not installed: ./scripts/setup.sh --drawings installs it"
            ) from None
        raise
