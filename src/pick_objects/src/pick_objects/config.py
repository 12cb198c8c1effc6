"""Settings of the errand and of its node."""

from dataclasses import dataclass

from planar.config.listing import Section
from planar.config.parameters import POSITIVE, ZERO_OR_MORE, at_least, check_parameters, parameter


@dataclass(frozen=True)
class ErrandSettings:
    """How long things take, how patient the robot is, and what it makes of failures."""

    pickup_seconds: float = parameter(5.0, "how long picking up takes", "s", ZERO_OR_MORE)
    dropoff_seconds: float = parameter(0.0, "how long setting down takes", "s", ZERO_OR_MORE)
    goal_timeout: float = parameter(180.0, "a goal not reached by then has failed", "s", POSITIVE)
    attempts: int = parameter(
        3,
        "how often a place is tried, each time from the next of its poses, before it is given up",
        bounds=at_least(1),
    )
    retry_seconds: float = parameter(1.0, "pause before a place is tried again", "s", ZERO_OR_MORE)
    on_failure: str = parameter(
        "stop",
        "after a delivery that failed: stop, or continue with the next one",
        choices=("stop", "continue"),
    )
    order: str = parameter(
        "given",
        "of the deliveries: given, or shortest (by the lengths of move_base's plans)",
        choices=("given", "shortest"),
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class NodeSettings:
    """What the node carries out, and where it finds what it needs."""

    zones_file: str = parameter(
        "",
        "path of the YAML file with the places pickup and dropoff, and any others",
        required="the path of a YAML file of zones",
    )
    mission_file: str = parameter(
        "", "YAML file of a mission; empty: from the place pickup to the place dropoff"
    )
    serve: bool = parameter(False, "whether to wait for missions sent to the action deliver, until shutdown")
    wait_for: str = parameter(
        "", "nodes of ours, by spaces, that are to be ready too before the mission begins"
    )
    resume: bool = parameter(
        False,
        "for a node that is respawned: whether to go on where the last was cut short, and to stay when done",
    )
    frame_id: str = parameter("map", "frame in which the places are given")
    server_timeout: float = parameter(
        60.0, "how long to wait for move_base and those nodes, by the wall clock", "s", POSITIVE
    )
    map_timeout: float = parameter(
        10.0, "how long to wait for a map to check the places against, by the wall clock", "s", POSITIVE
    )

    def __post_init__(self):
        check_parameters(self)


CONFIG_FILES = {
    "pick_objects.yaml": Section(
        "",
        ErrandSettings,
        NodeSettings,
        about="Every parameter of pick_objects with its default. Seconds are simulated seconds.",
    )
}
