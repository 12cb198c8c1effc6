"""Parameters of the simulation, of the node sim_bridge and of fault_relay."""

import sys
from dataclasses import dataclass

from planar.config.config_file import Section
from planar.config.parameters import POSITIVE, Interval, check_parameters, parameter, parameters_of
from planar.config.settings import check
from planar.geometry.dock_field import DockField
from sim_bridge.noise import NOISE_PROFILES, NOT_NEGATIVE, NoiseSettings
from sim_bridge.power.battery import BatterySettings
from sim_bridge.rest.rules import FORMS, parse_rules

# With more, a single period of the odometry would take seconds [Hz].
MAX_PHYSICS_RATE = 100_000
# A robot whose name has one of these suffixes is that of a file.
FILE_SUFFIXES = (".urdf", ".xacro", ".xml")
# One control period, so that simulation and control run in parallel [s].
LATENCY = 0.1


def is_robot_file(name: str) -> bool:
    """Return whether the name of a robot is the path of a file."""
    return name.endswith(FILE_SUFFIXES)


@dataclass(frozen=True)
class SimulationSettings(NoiseSettings, BatterySettings, DockField):
    """Rates, noise, battery and docks of a simulation; rates in simulated time divide ``physics_rate``.

    Raises:
        SettingsError: A value is out of its bounds, or a rate does not divide ``physics_rate``.
    """

    physics_rate: int = parameter(
        200,
        "physics steps per second; every other rate must divide it",
        "Hz",
        Interval(1, MAX_PHYSICS_RATE),
    )
    odometry_rate: int = parameter(50, "rate of odom, /tf and base_pose_ground_truth", "Hz")
    scan_rate: int = parameter(10, "rate of scan", "Hz")

    def __post_init__(self):
        super().__post_init__()
        for name in ("odometry_rate", "scan_rate"):
            rate = getattr(self, name)
            divides = rate > 0 and self.physics_rate % rate == 0
            check(divides, name, f"a divisor of physics_rate ({self.physics_rate})", rate)


@dataclass(frozen=True)
class RunTimeSettings:
    """Parameters of the node sim_bridge that dynamic_reconfigure may change."""

    speed: float = parameter(
        1.0,
        "real-time factor; 0: as fast as the nodes of wait_for keep up",
        bounds=Interval(0.0, sys.float_info.max, "0 or a positive number"),
        dynamic=100.0,
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class BridgeSettings(RunTimeSettings):
    """Parameters of the node sim_bridge, beside those of SimulationSettings."""

    world: str = parameter("", "SDF file of the world", required="the path of an SDF file")
    dock: str = parameter("", "pose of a dock in the world: x y yaw [m, rad]; empty: none but the world's")
    objects_file: str = parameter(
        "",
        "YAML file of where objects are, for a detector (docs/how_to/find_objects.md); empty: none",
    )
    seed: int = parameter(0, "seed of all noise", bounds=NOT_NEGATIVE)
    wait_for: str = parameter(
        "", "names of the nodes, separated by spaces, that are synchronised with the simulation"
    )
    pace_all: bool = parameter(
        False,
        "with speed 0 or above 1, time waits until all other nodes on this machine rest, except bystanders",
    )
    bystanders: str = parameter(
        "", "beginnings of the names of nodes that pace_all does not wait for, separated by spaces"
    )
    pace: str = parameter(
        "",
        "how time passes beside nodes that are not synchronised: NODE:RULE, separated by spaces; rules: "
        f"{FORMS}; others have the rule of known_file, or one that is learned",
    )
    known_file: str = parameter(
        "", "YAML file of the rules of known programs; empty: config/known_nodes.yaml of sim_bridge"
    )
    static_publishers: str = parameter(
        "",
        "names of nodes, separated by spaces, whose static transforms the synchronised nodes receive before "
        "time passes",
    )
    latency: float = parameter(
        LATENCY,
        "simulated time after which messages of a synchronised node take effect",
        "s",
        POSITIVE,
    )
    faults_file: str = parameter(
        "", "YAML file with a list of faults (docs/reference/faults.md); empty: none"
    )
    skip_idle: bool = parameter(
        True,
        "steps in which no node has anything to do are skipped, unless another node listens or speed is 1 or "
        "less; otherwise all are taken, with the same result",
    )
    clock_rate: int = parameter(50, "rate of /clock; must divide odometry_rate", "Hz", POSITIVE)
    joint_state_rate: int = parameter(10, "rate of joint_states; must divide odometry_rate", "Hz", POSITIVE)
    strict: bool = parameter(
        False,
        "a missing mesh or model, or an element of a world or robot without effect, is an error; otherwise "
        "it is ignored with a warning",
    )
    noise: str = parameter(
        "turtlebot",
        f"noise profile of the sensors: {', '.join(NOISE_PROFILES)}; noise.yaml lists their values, each of "
        "which may also be set here by its name",
    )

    def __post_init__(self):
        super().__post_init__()
        parse_rules(self.pace)


@dataclass(frozen=True)
class RelaySettings:
    """Parameters of the node fault_relay, which injects faults between other nodes."""

    faults_file: str = parameter(
        "",
        "YAML file with a list of faults (docs/reference/faults.md), in seconds since the first /clock; "
        "empty: none",
    )
    seed: int = parameter(0, "seed of the faults' randomness", bounds=NOT_NEGATIVE)
    publish_tf: bool = parameter(
        False, "publish odom -> base of the faulty odometry on /tf; no other node may publish it then"
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class RobotSettings:
    """A robot and its start pose (parameters of the node sim_bridge)."""

    robot: str = parameter("turtlebot_lidar", "name of a robot, or a URDF or xacro file; empty: no robot")
    x: float = parameter(0.0, "start position in the world", "m")
    y: float = parameter(0.0, "start position in the world", "m")
    yaw: float = parameter(0.0, "start heading in the world", "rad")
    namespace: str = parameter("", "namespace of its topics")


# Parameters that are set by arguments of the launch file.
ARGUMENTS = ("world", "dock", "objects_file", "seed", "speed", "wait_for", "pace", "static_publishers")
_NOISE_VALUES = {each.name for each in parameters_of(NoiseSettings)}

CONFIG_FILES = {
    "sim_bridge.yaml": Section(
        "",
        *(each for each in parameters_of(SimulationSettings) if each.name not in _NOISE_VALUES),
        *(each for each in parameters_of(BridgeSettings) if each.name not in ARGUMENTS),
        about="Parameters of sim_bridge, except the launch file's arguments. Rates are in simulated time.",
    ),
    "fault_relay.yaml": Section("", *parameters_of(RelaySettings), about="Parameters of fault_relay."),
    "noise.yaml": Section(
        "",
        *(Section(name, noise) for name, noise in NOISE_PROFILES.items()),
        about="Noise profiles of sim_bridge, for reference: its parameter noise selects one of them.\n"
        "ideal: no noise. turtlebot: a Kobuki with a Kinect or a small lidar.\n"
        "high: the most that localization has to handle.",
    ),
}
