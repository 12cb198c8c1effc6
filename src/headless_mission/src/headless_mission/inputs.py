"""Inputs of a command, read before anything is started, so that a mistake is reported first."""

from dataclasses import dataclass
from typing import Iterable, Mapping

from evaluation.options import ErrandOptions, HomeOptions, MissionOptions, WorldOptions
from pick_objects import Mission, errand_mission, load_mission
from planar import OccupancyGrid, Pose2, SettingsError, load_map
from planar.maps.places import NamedPlace, load_pickup_and_dropoff, load_places, unreachable_reason
from sim_bridge import RobotProfile, load_world, robot_named
from sim_bridge.world import World


@dataclass(frozen=True, eq=False)
class WorldInputs:
    """A world and the robot in it."""

    world: World
    robot: RobotProfile


@dataclass(frozen=True, eq=False)
class HomeInputs(WorldInputs):
    """A world, its robot and its map."""

    grid: OccupancyGrid


@dataclass(frozen=True, eq=False)
class MissionInputs(HomeInputs):
    """A mission, and all named places."""

    mission: Mission
    places: Mapping[str, NamedPlace]


def read_world(options: WorldOptions) -> WorldInputs:
    """Read world and robot.

    Raises:
        PlanarError: As all functions below, with the name of what cannot be read.
    """
    return WorldInputs(load_world(options.world), robot_named(options.robot))


def read_home(options: HomeOptions) -> HomeInputs:
    """Read world, robot and map."""
    world, grid = load_world(options.world), load_map(options.map)
    return HomeInputs(world, robot_named(options.robot), grid)


def read_goals(options: HomeOptions, goals: Iterable[Pose2]) -> HomeInputs:
    """Read a home and check that all goals lie on its map; move_base reports goals in obstacles."""
    home = read_home(options)
    for number, pose in enumerate(goals, 1):
        if not home.grid.contains(home.grid.cells_of([[pose.x, pose.y]]))[0]:
            raise SettingsError(f"--goals: goal {number} ({pose.x:g}, {pose.y:g}) lies outside {options.map}")
    return home


def read_errand(options: ErrandOptions) -> MissionInputs:
    """Read the errand between the zones; the robot must be able to stand in them."""
    home, zones = read_home(options), load_places(options.zones)
    ends = load_pickup_and_dropoff(options.zones)
    for place in ends:
        problem = unreachable_reason(place, home.grid)
        if problem:
            raise SettingsError(f"{options.zones}: {problem}")
    errand = errand_mission(*ends)
    return MissionInputs(home.world, home.robot, home.grid, errand, zones)


def read_mission(options: MissionOptions) -> MissionInputs:
    """Read the mission, or the errand if no mission is given."""
    if options.mission is None:
        return read_errand(options)
    home, zones = read_home(options), load_places(options.zones)
    mission = load_mission(options.mission, zones, grid=home.grid)
    return MissionInputs(home.world, home.robot, home.grid, mission, mission.places)
