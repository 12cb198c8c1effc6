from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from supervision.command_line import argument, number, option


@dataclass(frozen=True)
class BuildHome:
    """Build a home from a map, a floor plan, a drawing or a world, or draw it in the browser.

    FILE is a map (YAML), a picture of a floor plan with --scale, a DXF, IFC or SDF file, or a plan.yaml; or
    the folder of a home, which is built again from its plan. Writes one folder: world, map, zones, mission,
    picture, plan and manifest (docs/get_started/own_home.md). Without FILE the editor opens.

    Exit code: 0 success, also Ctrl-C with --web; 2 invalid input.
    """

    file: Optional[Path] = argument(
        "map, picture, drawing, world, plan or folder of a home",
        default=None,
        type=Path,
        metavar="FILE",
        nargs="?",
    )
    output: Optional[Path] = option(
        None, "folder of the home (default: the file's name in homes)", type=Path, metavar="FOLDER"
    )
    scale: Optional[float] = option(
        None,
        "size of a pixel of a picture, or of a unit of a DXF file, in metres",
        type=number,
        metavar="METRES",
    )
    web: bool = option(False, "edit it in the browser: prints the URL of the page")
    web_port: Optional[str] = option(
        None,
        "address of that page (default: a free port of 127.0.0.1); implies --web",
        metavar="[ADDRESS:]PORT",
    )
    frame_of: str = option("", "origin of a page that shows the editor inside of it", metavar="ORIGIN")

    def run(self) -> int:
        from home_builder.source import folder_of, read_source

        folder = folder_of(self.file, self.output)
        if self.web or self.web_port is not None or self.file is None:
            return self._edit(folder)
        return self._build(read_source(self.file, self.scale), folder)

    def _build(self, plan, folder: Path) -> int:
        from home_builder.folder import build_home

        for remark in build_home(plan, folder):
            print(f"warning: {remark}")
        openings = sum(len(wall.openings) for wall in plan.walls)
        walls = f"{len(plan.walls)} walls, {openings} doors and windows"
        print(f"{folder}: {walls}, {len(plan.furniture)} pieces of furniture")
        print(f"run its mission: ./scripts/home_service.sh --home {folder}")
        return 0

    def _edit(self, folder: Path) -> int:
        from home_builder.editor.server import EditorServer, address_and_port
        from home_builder.editor.session import EditorSession
        from home_builder.source import read_source

        address = address_and_port(self.web_port or "127.0.0.1:0")
        plan = None if self.file is None else read_source(self.file, self.scale)
        server = EditorServer(EditorSession(folder, plan), *address, self.frame_of)
        print(f"edit the home: {server.url}")
        print(f"every change is saved in {folder}; Ctrl-C ends", flush=True)
        server.serve_until_interrupted()
        return 0
