"""Options shared by several commands, as frozen dataclasses to inherit from."""

import math
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Tuple

from planar import Pose2
from planar.errors import SettingsError
from planar.geometry.pose import pose_of_text
from planar.maps.home_folder import HomeFolder, load_home
from planar.maps.places import load_places
from sim_bridge.config import is_robot_file
from supervision.command_line import number, option, seconds, seed
from supervision.view_options import ViewOptions

ROOT = Path(__file__).resolve().parents[4]
HOME_WORLD, HOME_MAP = ROOT / "map/home.world", ROOT / "map/home.yaml"
RUN_SECONDS = 900.0
# Place of the zones at which a dock stands; its pose is that of the dock.
DOCK_PLACE = "dock"
# Options that are written to result.json under their names.
RESULT_OPTIONS = ("seed", "world", "robot", "map", "mission")


def robot_name(text: str) -> str:
    """Return the name of a robot, or the absolute path of its file, which is read by other processes."""
    is_relative = is_robot_file(text) and not text.startswith("~")
    return str(Path(text).absolute()) if is_relative else text


@dataclass(frozen=True)
class WorldOptions:
    """World, robot and seed."""

    world: Path = option(HOME_WORLD, "SDF world", type=Path)
    robot: str = option(
        "turtlebot_lidar",
        "robot profile of sim_bridge, or a .urdf or .xacro file",
        type=robot_name,
        metavar="NAME|FILE",
    )
    seed: int = option(0, "seed of all noise and particles", type=seed)
    dock: Optional[Tuple[float, float, float]] = option(
        None,
        "pose of a charging dock in the world: its front, facing YAW (default: the place dock of the zones)",
        nargs=3,
        type=number,
        metavar=("X", "Y", "YAW"),
    )

    home: Optional[Path] = option(
        None,
        "folder of a home, made by build_home.sh: its world, map, zones and mission",
        type=Path,
        metavar="FOLDER",
    )

    def __post_init__(self) -> None:
        """Take the parts of the home that were not given. Raises SettingsError."""
        if self.home is not None:
            self._take_parts(load_home(self.home))

    def _take_parts(self, home: HomeFolder) -> None:
        defaults = {item.name: item.default for item in fields(self)}
        if self.world not in (defaults["world"], home.world, home.world.resolve()):
            raise SettingsError(
                f"--world: {self.world} does not belong to the home {self.home}; leave one of them out"
            )
        for name in ("world", "map", "zones", "mission", "semantic_map", "objects"):
            if name in defaults and getattr(self, name) == defaults[name]:
                object.__setattr__(self, name, getattr(home, name))

    def dock_in_world(self) -> Optional[Pose2]:
        """Return the pose of the dock; None if there is none.

        Raises:
            SettingsError: The pose is out of range.
        """
        return None if self.dock is None else pose_of_text(" ".join(map(repr, self.dock)), "--dock")


@dataclass(frozen=True)
class HomeOptions(WorldOptions):
    """A world with a map."""

    map: Path = option(HOME_MAP, "map of that world", type=Path)

    @property
    def lacks_map(self) -> bool:
        """Whether another world than the home was chosen without a map of it."""
        return self.map is HOME_MAP and self.world.resolve() != HOME_WORLD.resolve()

    @property
    def navigation_zones(self) -> Optional[Path]:
        """File of the home's keep-out and speed zones; None if there is none. Raises SettingsError."""
        return None if self.home is None else load_home(self.home).navigation_zones

    def files(self) -> Dict[str, Any]:
        """Return the files as arguments of launch files."""
        zones = self.navigation_zones
        limits = {} if zones is None else {"navigation_zones_file": zones.resolve()}
        return {"map_file": self.map.resolve(), **limits}


@dataclass(frozen=True)
class DrivingOptions(HomeOptions):
    """A home in which the robot navigates."""

    planner: str = option(
        "",
        "local planner: official or my_package.my_module/MyPlanner (default: the robot's preset)",
        metavar="NAME",
    )

    def files(self) -> Dict[str, Any]:
        """Return the files and the planner as arguments of launch files.

        Raises:
            SettingsError: If there is no such planner.
        """
        if not self.planner:
            return super().files()
        from move_base_lite.control import check_local_planner  # late: slow to import

        check_local_planner(self.planner)
        return {**super().files(), "planner": self.planner}


@dataclass(frozen=True)
class ErrandOptions(HomeOptions):
    """A home with zones."""

    zones: Path = option(ROOT / "map/zones.yaml", "YAML of the zones", type=Path)

    def dock_in_world(self) -> Optional[Pose2]:
        """Return the pose of ``--dock``, else that of the place ``dock`` of the zones, else None.

        Raises:
            PlanarError: The pose is out of range, or the zones cannot be read.
        """
        if self.dock is not None:
            return super().dock_in_world()
        place = load_places(self.zones).get(DOCK_PLACE)
        return None if place is None else place.pose

    def files(self) -> Dict[str, Any]:
        return {**super().files(), "zones_file": self.zones.resolve()}


@dataclass(frozen=True)
class MissionOptions(ErrandOptions, DrivingOptions):
    """A home with a mission, or with the errand between the zones."""

    mission: Optional[Path] = option(
        None, "run the deliveries of this file instead (docs/reference/missions.md)", type=Path
    )
    semantic_map: Optional[Path] = option(
        None, "what is usually where, to search objects by (docs/how_to/find_objects.md)", type=Path
    )
    objects: Optional[Path] = option(
        None, "where objects truly are, for the simulated detector (default: no detector)", type=Path
    )

    def files(self) -> Dict[str, Any]:
        given = {
            "mission_file": self.mission,
            "semantic_map_file": self.semantic_map,
            "objects_file": self.objects,
        }
        return {**super().files(), **{key: path.resolve() for key, path in given.items() if path is not None}}


@dataclass(frozen=True)
class LaunchPlan:
    """A launch file and its arguments.

    Attributes:
        file: Name of the launch file.
        arguments: Its arguments.
        is_simulated: It starts a simulator.
        bags: Profile of the topics to record; None: no bags.
        respawned: Nodes that roslaunch restarts if they die.
        package: Package of the launch file.
        tool: Tool of the cockpit that is open at first.
    """

    file: str
    arguments: Mapping[str, object]
    is_simulated: bool = True
    bags: Optional[str] = None
    respawned: Tuple[str, ...] = ()
    package: str = "home_service"
    tool: Optional[str] = None

    def with_respawn(self, *nodes: str) -> "LaunchPlan":
        """Return the plan with these nodes restarted if they die."""
        return replace(self, arguments={**self.arguments, "respawn": "true"}, respawned=nodes)


@dataclass(frozen=True)
class RunOptions(ViewOptions):
    """A run of a graph, which writes a run folder."""

    timeout: Optional[float] = option(
        None,
        f"the run fails after N seconds of wall time (default: {RUN_SECONDS:g}; never for what Ctrl-C ends)",
        type=seconds,
    )
    gif: bool = option(False, "also leave run.gif, the run as an animation")

    @property
    def name(self) -> str:
        """Name of the command, which is that of its module."""
        return type(self).__module__.rpartition(".")[2]

    @property
    def time_limit(self) -> float:
        """Wall-clock time that the run may take [s]."""
        if self.timeout is not None:
            return self.timeout
        return math.inf if self.is_interactive else RUN_SECONDS

    def result_fields(self) -> Dict[str, Any]:
        """Return the options that are written to result.json."""
        given = {item.name: getattr(self, item.name) for item in fields(self) if item.name in RESULT_OPTIONS}
        paths = {name: str(value) for name, value in given.items() if isinstance(value, Path)}
        shown = {name: value for name, value in {**given, **paths}.items() if value is not None}
        return {**shown, "speed": self.effective_speed}


@dataclass(frozen=True)
class GraphOptions(RunOptions, WorldOptions):
    """A run in the simulated world."""

    record: Optional[str] = option(
        None,
        "record bags: scans, odometry and ground truth, or everything (docs/how_to/record_and_replay.md)",
        choices=("inputs", "all"),
    )
    strict: bool = option(False, "a setting without effect, such as an unknown parameter, is an error")

    def launch(self, file: str, **arguments: object) -> LaunchPlan:
        """Return the plan for a launch file of home_service with this world, robot and seed."""
        world = {"world_file": self.world.resolve(), "robot": self.robot, "seed": self.seed}
        strict = {"strict": "true"} if self.strict else {}
        dock = self.dock_in_world()
        if dock is not None:
            arguments = {**arguments, "dock": f"{dock.x!r} {dock.y!r} {dock.yaw!r}"}
        return LaunchPlan(file, {**world, **strict, **arguments}, bags=self.record)


# Respawned nodes of a mapping run: they resume from a checkpoint.
MAPPING_NODES, EXPLORING_NODES = ("slam_gmapping", "robot_state_publisher"), ("move_base", "explore")


@dataclass(frozen=True)
class MappingOptions(GraphOptions):
    """A run that saves a map."""

    save: Optional[Path] = option(
        None, "write STEM.pgm and STEM.yaml (default: map in the run folder)", type=Path, metavar="STEM"
    )

    def mapping(self, explores: bool) -> LaunchPlan:
        """Return the plan for SLAM, with exploration if ``explores``."""
        if explores:
            return self.launch("mapping.launch", autostart="true").with_respawn(
                *MAPPING_NODES, *EXPLORING_NODES
            )
        return self.launch("slam.launch").with_respawn(*MAPPING_NODES)
