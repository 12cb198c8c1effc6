"""Inputs of a command, read before anything is started, so that a mistake is reported first."""

from dataclasses import dataclass, replace
from typing import Iterable, Mapping, Optional

from evaluation.options import (
    ErrandOptions,
    GraphOptions,
    HomeOptions,
    MappingOptions,
    MissionOptions,
    WorldOptions,
)
from evaluation.verdict import true_places
from pick_objects import Mission, errand_mission, load_mission
from planar import OccupancyGrid, Pose2, SettingsError, load_map
from planar.maps.places import NamedPlace, load_pickup_and_dropoff, load_places, unreachable_reason
from planar.maps.semantic_map import SemanticMap, load_objects, load_semantic_map
from sim_bridge import RobotProfile, load_world, robot_named
from sim_bridge.docks import with_dock
from sim_bridge.sensors.object_detector import with_object_detector
from sim_bridge.world import World

# Frames of the launch files of localization, SLAM and navigation (REP 105).
ODOM_FRAME, BASE_FRAME = "odom", "base_footprint"


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
    """A mission, all named places with the true ones of objects, and what is usually where."""

    mission: Mission
    places: Mapping[str, NamedPlace]
    semantic_map: Optional[SemanticMap] = None


def read_world(options: WorldOptions) -> WorldInputs:
    """Read world and robot.

    Raises:
        PlanarError: As all functions below, with the name of what cannot be read.
    """
    return WorldInputs(_world_of(options), robot_named(options.robot))


def _world_of(options: WorldOptions) -> World:
    """Return the world, with the dock of the options."""
    world, dock = load_world(options.world), options.dock_in_world()
    return world if dock is None else with_dock(world, dock)


def read_home(options: HomeOptions) -> HomeInputs:
    """Read world, robot and map; over ROS, the robot must publish the frames of navigation."""
    if options.lacks_map:
        stem = options.world.with_suffix("")
        raise SettingsError(
            f"{options.world}: no map given, and map/home.yaml is that of map/home.world;\n"
            f"  ./scripts/map_home.sh --world {options.world} --save {stem}\n"
            f"makes one for --map {stem}.yaml"
        )
    world, grid, robot = _world_of(options), load_map(options.map), robot_named(options.robot)
    if isinstance(options, GraphOptions):
        check_frames(options.robot, robot)
    return HomeInputs(world, robot, grid)


def read_mapped_world(options: MappingOptions) -> WorldInputs:
    """Read world and robot; the robot must publish the frames that SLAM uses."""
    stage = read_world(options)
    check_frames(options.robot, stage.robot)
    return stage


def check_frames(name: str, robot: RobotProfile) -> None:
    """Check that a robot publishes the transform from which localization and navigation start.

    Args:
        name: Its name or file, for the message.
        robot: The robot.

    Raises:
        SettingsError: It publishes other frames, or none.
    """
    odometry = robot.odometry
    published = f"{odometry.frame} -> {odometry.base_frame}" if odometry.sends_transform else "no transform"
    is_complete = odometry.sends_transform and BASE_FRAME in robot.frames_below(odometry.base_frame)
    if odometry.frame != ODOM_FRAME or not is_complete:
        raise SettingsError(
            f"{name}: its odometry publishes {published}, but localization and navigation expect "
            f"{ODOM_FRAME} -> {BASE_FRAME}; set odometryFrame, robotBaseFrame and publishTf of its drive"
        )


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
    """Read the mission, or the errand if no mission is given, and what is needed to search objects."""
    semantic_map = None if options.semantic_map is None else load_semantic_map(options.semantic_map)
    objects = () if options.objects is None else load_objects(options.objects)
    if options.mission is None:
        inputs = read_errand(options)
    else:
        home, zones = read_home(options), load_places(options.zones)
        mission = load_mission(options.mission, zones, grid=home.grid, semantic_map=semantic_map)
        inputs = MissionInputs(home.world, home.robot, home.grid, mission, mission.places)
    inputs.mission.check_searches(semantic_map)
    robot = with_object_detector(inputs.robot, objects)
    places = {**inputs.places, **true_places(objects)}
    return replace(inputs, robot=robot, places=places, semantic_map=semantic_map)
