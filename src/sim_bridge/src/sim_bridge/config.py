"""Settings of the simulation and of its node."""

from dataclasses import dataclass

from planar.config.parameters import Bounds, check_parameters, parameter
from planar.config.settings import check
from sim_bridge.noise import NoiseSettings

# Hertz; with more, a single period of the odometry would take seconds.
HIGHEST_PHYSICS_RATE = 100_000


@dataclass(frozen=True)
class SimulationSettings(NoiseSettings):
    """Rates are in hertz of simulated time and must divide ``physics_rate``."""

    physics_rate: int = 200
    odometry_rate: int = 50
    scan_rate: int = 10

    def __post_init__(self):
        super().__post_init__()
        is_sane = 0 < self.physics_rate <= HIGHEST_PHYSICS_RATE
        check(is_sane, "physics_rate", f"between 1 and {HIGHEST_PHYSICS_RATE}", self.physics_rate)
        for name in ("odometry_rate", "scan_rate"):
            rate = getattr(self, name)
            divides = rate > 0 and self.physics_rate % rate == 0
            check(divides, name, f"a divisor of physics_rate ({self.physics_rate})", rate)


@dataclass(frozen=True)
class BridgeSettings:
    """``strict``: a mesh or model that the world lacks is an error.

    ``noise``: a profile of sim_bridge.noise; single values of it may be set beside it.

    ``wait_for``: names of nodes, separated by spaces; rates in hertz must divide the odometry's.
    """

    world: str = ""
    strict: bool = False
    seed: int = 0
    speed: float = 1.0
    noise: str = "turtlebot"
    wait_for: str = ""
    clock_rate: int = 50
    joint_state_rate: int = 10

    def __post_init__(self):
        check(self.world != "", "world", "the path of an SDF file", self.world)
        check(self.seed >= 0, "seed", "not negative", self.seed)
        check(0.0 <= self.speed < float("inf"), "speed", "0 or a positive number", self.speed)
        check(self.clock_rate > 0, "clock_rate", "positive", self.clock_rate)
        check(self.joint_state_rate > 0, "joint_state_rate", "positive", self.joint_state_rate)


@dataclass(frozen=True)
class RobotSettings:
    """``robot``: a profile's name (none: no robot). It starts at x, y, yaw in the world.

    Its topics are below ``namespace``.
    """

    robot: str = "turtlebot_lidar"
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    namespace: str = ""


@dataclass(frozen=True)
class RunTimeSettings:
    """What dynamic_reconfigure may change."""

    speed: float = parameter(
        1.0, "times real time; 0: as fast as the nodes of wait_for keep up", bounds=Bounds(0.0), dynamic=100.0
    )

    def __post_init__(self):
        check_parameters(self)
