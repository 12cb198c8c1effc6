"""What a home is built from: a folder, a plan file, or a file of another kind."""

from pathlib import Path
from typing import Optional

from home_builder.errors import ImportPlanError
from home_builder.imports import MAPS, import_plan
from home_builder.plan.file import load_plan
from home_builder.plan.model import HomePlan
from planar.config.yaml_table import read_table
from planar.maps.home_folder import MANIFEST, PLAN

HOMES = Path("homes")


def read_source(source: Path, scale: Optional[float] = None) -> HomePlan:
    """Return the plan of a home's folder or plan file, or that of an imported file.

    Args:
        source: Folder, plan.yaml, or a file to import.
        scale: Size of a pixel or unit [m]; only for pictures and DXF files.

    Raises:
        PlanarError: It cannot be read.
    """
    if source.is_dir():
        if not (source / PLAN).is_file():
            raise ImportPlanError(f"{source}: has no {PLAN}; give the file of which a home is to be made")
        return load_plan(source / PLAN)
    if source.suffix.lower() in MAPS and source.is_file() and "walls" in read_table(source):
        return load_plan(source)
    return import_plan(source, scale)


def folder_of(source: Optional[Path], output: Optional[Path]) -> Path:
    """Return the folder of the home that is built from a source.

    Args:
        source: Folder, plan.yaml, or a file to import; None for a home that is drawn.
        output: Folder that was asked for.

    Raises:
        ImportPlanError: The folder has other files already.
    """
    if output is None:
        output = _default_folder(source)
    is_home = any((output / name).exists() for name in (MANIFEST, PLAN))
    if output.is_dir() and any(output.iterdir()) and not is_home:
        raise ImportPlanError(f"--output: {output} has other files and is no home; choose a new folder")
    return output


def _default_folder(source: Optional[Path]) -> Path:
    if source is None:
        return HOMES / "home"
    if source.is_dir():
        return source
    return source.parent if source.name == PLAN else HOMES / source.stem
