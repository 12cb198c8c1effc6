"""Settings of the simulation and of its node: every parameter once, with its default and meaning."""

import sys
from dataclasses import dataclass

from planar.config.listing import Section
from planar.config.parameters import POSITIVE, Interval, check_parameters, parameter, parameters_of
from planar.config.settings import check
from sim_bridge.noise import NOISE_PROFILES, NOT_NEGATIVE, NoiseSettings

# Hertz; with more, a single period of the odometry would take seconds.
HIGHEST_PHYSICS_RATE = 100_000
# Seconds: a period of control, so that simulation and control are carried out side by side.
LATENCY = 0.1


@dataclass(frozen=True)
class SimulationSettings(NoiseSettings):
    """Rates are in hertz of simulated time and must divide ``physics_rate``."""

    physics_rate: int = parameter(
        200,
        "steps of physics a second; every other rate must divide it",
        "Hz",
        Interval(1, HIGHEST_PHYSICS_RATE),
    )
    odometry_rate: int = parameter(50, "odom, /tf and base_pose_ground_truth", "Hz")
    scan_rate: int = parameter(10, "scan", "Hz")

    def __post_init__(self):
        super().__post_init__()
        for name in ("odometry_rate", "scan_rate"):
            rate = getattr(self, name)
            divides = rate > 0 and self.physics_rate % rate == 0
            check(divides, name, f"a divisor of physics_rate ({self.physics_rate})", rate)


@dataclass(frozen=True)
class RunTimeSettings:
    """What dynamic_reconfigure may change."""

    speed: float = parameter(
        1.0,
        "times real time; 0: as fast as the nodes of wait_for keep up",
        bounds=Interval(0.0, sys.float_info.max, "0 or a positive number"),
        dynamic=100.0,
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class BridgeSettings(RunTimeSettings):
    """Of the node; single values of the noise may be set beside it."""

    world: str = parameter("", "world that is simulated", required="the path of an SDF file")
    seed: int = parameter(0, "all noise follows from it", bounds=NOT_NEGATIVE)
    wait_for: str = parameter("", "names of nodes, by spaces, that the simulation stays in step with")
    static_publishers: str = parameter(
        "", "names of nodes, by spaces, whose static transforms those of wait_for have before time passes"
    )
    latency: float = parameter(
        LATENCY,
        "from the moment at which a node in step looks at the world until what it then sends takes effect",
        "s",
        POSITIVE,
    )
    faults_file: str = parameter("", "YAML with a list of faults (docs/reference/faults.md); empty: none")
    clock_rate: int = parameter(50, "/clock; must divide odometry_rate", "Hz", POSITIVE)
    joint_state_rate: int = parameter(10, "joint_states; must divide odometry_rate", "Hz", POSITIVE)
    strict: bool = parameter(
        False, "a mesh or model that the world lacks is an error; otherwise it is named and left out"
    )
    noise: str = parameter(
        "turtlebot",
        f"noise profile of the sensors: {', '.join(NOISE_PROFILES)}; noise.yaml lists their values, each of "
        "which may also be set here by its name",
    )


@dataclass(frozen=True)
class RelaySettings:
    """Of the node that puts faults between other people's nodes."""

    faults_file: str = parameter(
        "",
        "YAML with a list of faults (docs/reference/faults.md); times since the first clock; empty: none",
    )
    seed: int = parameter(0, "what is random about faults follows from it", bounds=NOT_NEGATIVE)
    publish_tf: bool = parameter(
        False, "/tf has odom -> base as the faulty odometry tells it; nobody else may publish that then"
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class RobotSettings:
    """A robot and where it starts in the world."""

    robot: str = parameter("turtlebot_lidar", "name of a robot, or a URDF or xacro file; empty: no robot")
    x: float = parameter(0.0, "where it starts in the world", "m")
    y: float = parameter(0.0, "where it starts in the world", "m")
    yaw: float = parameter(0.0, "its heading there", "rad")
    namespace: str = parameter("", "of its topics")


# What the arguments of the launch file set.
ARGUMENTS = ("world", "seed", "speed", "wait_for", "static_publishers")
_NOISE_VALUES = {each.name for each in parameters_of(NoiseSettings)}

CONFIG_FILES = {
    "sim_bridge.yaml": Section(
        "",
        *(each for each in parameters_of(SimulationSettings) if each.name not in _NOISE_VALUES),
        *(each for each in parameters_of(BridgeSettings) if each.name not in ARGUMENTS),
        about="Settings of sim_bridge, but for the launch file's arguments. Rates are of simulated time.",
    ),
    "fault_relay.yaml": Section("", *parameters_of(RelaySettings), about="Settings of fault_relay."),
    "noise.yaml": Section(
        "",
        *(Section(name, noise) for name, noise in NOISE_PROFILES.items()),
        about="The noise profiles of sim_bridge, to look up: its parameter noise names one of them.\n"
        "ideal: what the sensors say is true. turtlebot: a Kobuki with a Kinect or a small lidar.\n"
        "bad: what a localization should still bear.",
    ),
}
