"""Settings of auto_docking_lite."""

from dataclasses import dataclass

from planar.config.config_file import Section
from planar.config.parameters import POSITIVE, ZERO_OR_MORE, Interval, check_parameters, parameter
from planar.geometry.dock_field import DockField

_RATE = Interval(1.0, 50.0)


@dataclass(frozen=True)
class DockingSettings(DockField):
    """Settings of docking and undocking; those of the field are the geometry that is expected."""

    staging_distance: float = parameter(
        0.9, "distance of the base from the dock at the staging pose, on its middle line", "m", Interval(0.5)
    )
    max_retries: int = parameter(4, "further attempts after one that failed", bounds=ZERO_OR_MORE)
    docking_timeout: float = parameter(240.0, "time after which docking has failed", "s", POSITIVE)
    blocked_timeout: float = parameter(
        10.0, "time that the robot waits for something in its way, e.g. a person", "s", POSITIVE
    )
    charge_seconds: float = parameter(1.0, "time of charging after which the robot has docked", "s", POSITIVE)
    max_speed: float = parameter(0.3, "speed on the way to the staging pose", "m/s", POSITIVE)
    approach_speed: float = parameter(0.2, "speed along the middle line", "m/s", POSITIVE)
    contact_speed: float = parameter(0.06, "speed just before the contacts", "m/s", POSITIVE)
    turn_rate: float = parameter(0.9, "largest turn rate", "rad/s", POSITIVE)
    scan_rate: float = parameter(0.7, "turn rate while the robot searches for the dock", "rad/s", POSITIVE)
    robot_radius: float = parameter(0.18, "radius of the robot, for obstacles in the scan", "m", POSITIVE)
    undock_distance: float = parameter(0.45, "distance that the robot leaves the dock by", "m", POSITIVE)
    undock_speed: float = parameter(0.15, "speed of undocking", "m/s", POSITIVE)
    prior_deviation: float = parameter(
        0.3, "standard deviation of the position of a known dock", "m", POSITIVE
    )
    controller_frequency: float = parameter(10.0, "rate of control", "Hz", _RATE)

    def __post_init__(self):
        check_parameters(self)

    @property
    def period(self) -> float:
        """Control period [s]."""
        return 1.0 / self.controller_frequency


@dataclass(frozen=True)
class NodeSettings(DockingSettings):
    """Settings of the node: those of docking, and what the dock and the frames are."""

    dock: str = parameter("", "pose of the dock in the map: x y yaw [m, rad]; empty: not known")
    use_move_base: bool = parameter(
        False, "drive to a dock out of its field, or around obstacles, by move_base"
    )
    global_frame: str = parameter("map", "frame of the dock's pose")
    robot_base_frame: str = parameter("base_footprint", "frame of the robot")
    odom_frame: str = parameter("odom", "frame of the odometry")
    min_abs_v: float = parameter(
        0.01, "smallest speed that is sent (kobuki_auto_docking)", "m/s", ZERO_OR_MORE
    )
    min_abs_w: float = parameter(
        0.1, "smallest turn rate that is sent (kobuki_auto_docking)", "rad/s", ZERO_OR_MORE
    )


CONFIG_FILES = {
    "auto_docking.yaml": Section("", NodeSettings, about="Every parameter of auto_docking with its default."),
}
