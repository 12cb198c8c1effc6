from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from home_service.options import GraphOptions
from supervision.command_line import option


@dataclass(frozen=True)
class Launch(GraphOptions):
    """Starts the simulated home with the robot in it, until Ctrl-C."""

    map: Optional[Path] = option(None, "show this map of the world with it", type=Path, metavar="FILE")

    is_ended_by_a_person = True

    def run(self) -> int:
        from home_service.ros.conducting import stay_open
        from home_service.stage import read_stage
        from planar import load_map

        read_stage(self)
        given = {}
        if self.map is not None:
            load_map(self.map)
            given["map_file"] = self.map.resolve()
        launch = self.launch("open_world.launch", **given)
        return stay_open(self, launch, "the home is open; Ctrl-C closes it")
