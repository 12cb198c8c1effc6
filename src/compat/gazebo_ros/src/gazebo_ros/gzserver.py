"""gzserver, backed by sim_bridge: the command line names the world; robots are spawned later."""

import os
import sys
from pathlib import Path
from typing import List, Optional

EMPTY_WORLD = Path(__file__).parent / "empty.world"
# Options of gazebo and gzserver 7 to 11 that take a value; all others are flags.
OPTIONS_WITH_VALUE = (
    "-e --physics -p --play -s --server-plugin -o --profile --seed --iters --initial_sim_time "
    "--record_encoding --record_path --record_period --record_filter -g --gui-plugin --gui-client-plugin"
).split()


def world_argument(arguments: List[str]) -> Optional[str]:
    """The world file in gzserver's arguments; None if there is none."""
    words = iter(arguments)
    for word in words:
        if word in OPTIONS_WITH_VALUE:
            next(words, None)
        elif not word.startswith(("-", "_")) and ":=" not in word:
            return word
    return None


def find_world(world: str, folders: List[Path]) -> Path:
    """Resolve a world file: as given, below one of the folders, or Gazebo's empty world."""
    path = Path(world)
    candidates = [path, *(folder / path for folder in folders)]
    for candidate in candidates:
        if candidate.is_file():
            return candidate.resolve()
    return EMPTY_WORLD if path.name == EMPTY_WORLD.name else path


def main() -> None:
    """Run sim_bridge without a robot."""
    from sim_bridge.ros.node import main as simulate

    folders = [Path(folder) for folder in os.environ.get("GAZEBO_RESOURCE_PATH", "").split(":") if folder]
    world = find_world(world_argument(sys.argv[1:]) or EMPTY_WORLD.name, folders)
    sys.argv[1:] = [word for word in sys.argv[1:] if ":=" in word] + [f"_world:={world}", "_robot:=''"]
    simulate()
