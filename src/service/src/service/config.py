"""Settings of the service."""

from dataclasses import dataclass

from planar.config.config_file import Section
from planar.config.parameters import POSITIVE, ZERO_OR_MORE, Interval, at_least, check_parameters, parameter

SHARE = Interval(0.0, 1.0)


@dataclass(frozen=True)
class EnergySettings:
    """Figures by which charging is planned; charge is a share of the battery's capacity."""

    drive_hours: float = parameter(3.0, "time that a full battery lasts while driving", "h", POSITIVE)
    stand_hours: float = parameter(6.0, "time that a full battery lasts while standing", "h", POSITIVE)
    charge_hours: float = parameter(1.5, "time to charge an empty battery", "h", POSITIVE)
    reserve: float = parameter(0.2, "charge with which the robot is back in its dock", bounds=SHARE)
    full: float = parameter(0.95, "charge at which charging ends if something is due", bounds=SHARE)
    idle_charge: float = parameter(0.9, "charge below which an idle robot returns to its dock", bounds=SHARE)

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class ServiceSettings:
    """Durations, patience and bounds."""

    pickup_seconds: float = parameter(5.0, "duration of picking up", "s", ZERO_OR_MORE)
    dropoff_seconds: float = parameter(0.0, "duration of setting down", "s", ZERO_OR_MORE)
    goal_timeout: float = parameter(180.0, "time after which a goal has failed", "s", POSITIVE)
    attempts: int = parameter(3, "number of attempts to reach a place", bounds=at_least(1))
    retry_seconds: float = parameter(1.0, "pause before the next attempt", "s", ZERO_OR_MORE)
    dock_retry_seconds: float = parameter(60.0, "pause before the next attempt to dock", "s", POSITIVE)
    park_seconds: float = parameter(
        300.0, "idle time from which on the robot waits in its dock", "s", ZERO_OR_MORE
    )
    max_open: int = parameter(1000, "number of open requests; more are refused", bounds=at_least(1))
    replan_seconds: float = parameter(60.0, "longest time between two plans", "s", POSITIVE)

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class NodeSettings:
    """What the node works with."""

    zones_file: str = parameter(
        "", "path of the YAML file with named places", required="the path of a YAML file of zones"
    )
    mission_file: str = parameter("", "YAML file of a mission whose deliveries are requested once; or empty")
    requests_file: str = parameter(
        "", "JSON list of requests, each submitted at its unix_millis_request_time; or empty"
    )
    semantic_map_file: str = parameter(
        "",
        "YAML of what is usually where, to search objects by (docs/how_to/find_objects.md); or empty",
    )
    state_folder: str = parameter(
        "", "folder of the journal and of service.json", required="the path of a folder"
    )
    dock: str = parameter("", "pose of the dock in the map: x y yaw [m, rad]; empty: no dock")
    staging_distance: float = parameter(
        0.8, "distance before the dock to which drives to it lead", "m", POSITIVE
    )
    speed: float = parameter(0.3, "mean speed by which drives are planned", "m/s", POSITIVE)
    http_address: str = parameter("127.0.0.1", "address of the HTTP interface")
    http_port: int = parameter(0, "port of the HTTP interface; 0: a free one", bounds=Interval(0, 65535))
    wait_for: str = parameter("", "nodes that must be ready before the service starts, separated by spaces")
    frame_id: str = parameter("map", "frame of the places")
    server_timeout: float = parameter(
        60.0, "wall-clock time to wait for move_base and the map", "s", POSITIVE
    )

    def __post_init__(self):
        check_parameters(self)


CONFIG_FILES = {
    "service.yaml": Section(
        "",
        ServiceSettings,
        EnergySettings,
        NodeSettings,
        about="Every parameter of service with its default. Seconds are simulated seconds.",
    )
}
