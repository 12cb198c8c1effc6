"""Where, with which noise and parameters, and with which nodes localization is measured."""

import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List

import yaml

from helpers.worlds import HALLWAY, OFFICE, world_from_picture
from planar import OccupancyGrid, Pose2
from sim_bridge import SimulationSettings, load_world
from sim_bridge.noise import noise_named
from sim_bridge.views.true_map import true_map
from sim_bridge.world import World

ROOT = Path(__file__).resolve().parents[3]
NOISES = {name: SimulationSettings(**noise_named(name)) for name in ("turtlebot", "high")}
FRAMES = {"base_frame_id": "base_footprint"}
TURTLEBOT = yaml.safe_load((ROOT / "src/amcl_lite/config/turtlebot.yaml").read_text())
PARAMETERS = {"turtlebot": TURTLEBOT, "default": FRAMES}


@dataclass(frozen=True)
class Place:
    """A world, its true map, and where the robot starts."""

    name: str
    world: World
    grid: OccupancyGrid
    start: Pose2


def places() -> List[Place]:
    """The home first."""
    worlds = (
        ("home", load_world(str(ROOT / "map" / "home.world")), Pose2()),
        ("hallway", world_from_picture("hallway", HALLWAY), Pose2(2.0, 3.75)),
        ("office", world_from_picture("office", OFFICE), Pose2(1.0, 1.0)),
    )
    return [
        Place(name, world, true_map(world, inside=(start.x, start.y)), start) for name, world, start in worlds
    ]


def installed_nodes() -> Dict[str, str]:
    """Return the programs of the nodes to compare; warn if the official one is not installed."""
    lite = {"amcl_lite": str(ROOT / "src" / "amcl_lite" / "nodes" / "amcl_lite")}
    found = subprocess.run(["catkin_find", "amcl", "amcl"], stdout=subprocess.PIPE, check=False)
    # This workspace has a package amcl too, an alias of amcl_lite.
    programs = [path for path in found.stdout.decode().split() if ROOT not in Path(path).resolve().parents]
    official = [path for path in programs if Path(path).is_file()]
    if not official:
        print("amcl is not installed")
        return lite
    return {"amcl": official[0], **lite}
