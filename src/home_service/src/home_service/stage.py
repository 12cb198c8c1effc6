"""Everything that a command names, read before anything is started, so that a mistake is told first."""

from dataclasses import dataclass
from typing import Mapping

from home_service.options import ErrandOptions, HomeOptions, MissionOptions, WorldOptions
from pick_objects import Mission, errand_mission, load_mission
from planar import OccupancyGrid, load_map
from planar.maps.places import Place, load_places, places_of_errand
from sim_bridge import RobotProfile, load_world, robot_named
from sim_bridge.world import World


@dataclass(frozen=True, eq=False)
class Stage:
    """A world and the robot in it."""

    world: World
    robot: RobotProfile


@dataclass(frozen=True, eq=False)
class Home(Stage):
    """A stage with a map."""

    grid: OccupancyGrid


@dataclass(frozen=True, eq=False)
class MissionHome(Home):
    """A home, what is to be done in it, and every place that has a name."""

    mission: Mission
    places: Mapping[str, Place]


def read_stage(options: WorldOptions) -> Stage:
    """Raises PlanarError, as all below, naming what cannot be read."""
    return Stage(load_world(options.world), robot_named(options.robot))


def read_home(options: HomeOptions) -> Home:
    world, grid = load_world(options.world), load_map(options.map)
    return Home(world, robot_named(options.robot), grid)


def read_errand(options: ErrandOptions) -> MissionHome:
    """The errand between the zones."""
    home, zones = read_home(options), load_places(options.zones)
    errand = errand_mission(*places_of_errand(options.zones))
    return MissionHome(home.world, home.robot, home.grid, errand, zones)


def read_mission(options: MissionOptions) -> MissionHome:
    """The mission, or the errand if there is none."""
    if options.mission is None:
        return read_errand(options)
    home, zones = read_home(options), load_places(options.zones)
    mission = load_mission(options.mission, zones, grid=home.grid)
    return MissionHome(home.world, home.robot, home.grid, mission, mission.places)
