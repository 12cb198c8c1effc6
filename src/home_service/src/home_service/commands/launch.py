from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from evaluation.options import GraphOptions
from supervision.command_line import option


@dataclass(frozen=True)
class Launch(GraphOptions):
    """Start the simulated home with the robot in it, until Ctrl-C.

    Exit code: 0 ended by Ctrl-C, 1 failure or no result.json, 2 invalid input, 130 interrupted before it was
    ready.
    """

    map: Optional[Path] = option(None, "show this map of the world with it", type=Path)

    is_interactive = True

    def run(self) -> int:
        from evaluation.ros.run_modes import run_until_interrupted
        from headless_mission.inputs import read_world
        from planar import load_map

        read_world(self)
        given = {}
        if self.map is not None:
            load_map(self.map)
            given["map_file"] = self.map.resolve()
        launch = self.launch("open_world.launch", **given)
        return run_until_interrupted(self, launch, "the home is open; Ctrl-C closes it")
