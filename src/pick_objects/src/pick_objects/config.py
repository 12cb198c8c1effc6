"""Settings of the errand and of the node."""

from dataclasses import dataclass

from planar.config.config_file import Section
from planar.config.parameters import POSITIVE, ZERO_OR_MORE, at_least, check_parameters, parameter


@dataclass(frozen=True)
class ErrandSettings:
    """Durations, patience and the reaction to failures."""

    pickup_seconds: float = parameter(5.0, "duration of picking up", "s", ZERO_OR_MORE)
    dropoff_seconds: float = parameter(0.0, "duration of setting down", "s", ZERO_OR_MORE)
    goal_timeout: float = parameter(180.0, "time after which a goal has failed", "s", POSITIVE)
    attempts: int = parameter(
        3,
        "number of attempts to reach a place, each at the next of its poses",
        bounds=at_least(1),
    )
    retry_seconds: float = parameter(1.0, "pause before the next attempt", "s", ZERO_OR_MORE)
    on_failure: str = parameter(
        "stop",
        "after a failed delivery: stop the mission, or continue with the next delivery",
        choices=("stop", "continue"),
    )
    order: str = parameter(
        "given",
        "order of the deliveries: given, or shortest (by the lengths of move_base's plans)",
        choices=("given", "shortest"),
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class NodeSettings:
    """What the node carries out, and its inputs."""

    zones_file: str = parameter(
        "",
        "path of the YAML file with the places pickup and dropoff, and any others",
        required="the path of a YAML file of zones",
    )
    mission_file: str = parameter(
        "", "YAML file of a mission; empty: from the place pickup to the place dropoff"
    )
    semantic_map_file: str = parameter(
        "",
        "YAML of what is usually where, to search objects by (docs/how_to/find_objects.md); or empty",
    )
    serve: bool = parameter(False, "wait for missions sent to the action deliver, until shutdown")
    wait_for: str = parameter(
        "", "further nodes of this project, separated by spaces, that must be ready before the mission starts"
    )
    resume: bool = parameter(
        False,
        "for a respawned node: resume the interrupted mission, and keep running when it is done",
    )
    frame_id: str = parameter("map", "frame of the places")
    server_timeout: float = parameter(
        60.0, "wall-clock time to wait for move_base and the nodes of wait_for", "s", POSITIVE
    )
    map_timeout: float = parameter(
        10.0, "wall-clock time to wait for a map to check the places against", "s", POSITIVE
    )
    not_before: float = parameter(
        0.0,
        "simulated time before which no mission starts; a second before, the costmaps are cleared",
        "s",
        ZERO_OR_MORE,
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
