from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from supervision.command_line import argument, number, option


@dataclass(frozen=True)
class BuildHome:
    """Build a home from a map, a floor plan, a drawing or a world.

    FILE is a map (YAML), a picture of a floor plan with --scale, a DXF, IFC or SDF file, or a plan.yaml; or
    the folder of a home, which is built again from its plan. Writes one folder: world, map, zones, mission,
    picture, plan and manifest (docs/get_started/own_home.md).

    Exit code: 0 success, 2 invalid input.
    """

    file: Path = argument("map, picture, drawing, world, plan or folder of a home", type=Path, metavar="FILE")
    output: Optional[Path] = option(
        None, "folder of the home (default: the file's name in homes)", type=Path, metavar="FOLDER"
    )
    scale: Optional[float] = option(
        None,
        "size of a pixel of a picture, or of a unit of a DXF file, in metres",
        type=number,
        metavar="METRES",
    )

    def run(self) -> int:
        from home_builder.folder import build_home
        from home_builder.source import folder_of, read_source

        plan, folder = read_source(self.file, self.scale), folder_of(self.file, self.output)
        for remark in build_home(plan, folder):
            print(f"warning: {remark}")
        openings = sum(len(wall.openings) for wall in plan.walls)
        walls = f"{len(plan.walls)} walls, {openings} doors and windows"
        print(f"{folder}: {walls}, {len(plan.furniture)} pieces of furniture")
        print(f"run its mission: ./scripts/home_service.sh --home {folder}")
        return 0
