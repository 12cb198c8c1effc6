"""Settings of the markers."""

from dataclasses import dataclass

from planar.config.config_file import Section
from planar.config.parameters import POSITIVE, ZERO_OR_MORE, check_parameters, parameter


@dataclass(frozen=True)
class MarkerSettings:
    """Mode of the markers, and the source of the robot's pose."""

    zones_file: str = parameter(
        "",
        "path of the YAML file with the places pickup and dropoff",
        required="the path of a YAML file of zones",
    )
    mode: str = parameter(
        "service",
        "service: marker of the errand; mission: a marker for each object; demo: by the clock",
        choices=("service", "mission", "demo"),
    )
    pose_source: str = parameter(
        "tf",
        "source of the robot's pose: tf, amcl_pose, odom, or state (of pick_objects)",
        choices=("tf", "amcl_pose", "odom", "state"),
    )
    show_seconds: float = parameter(5.0, "demo: time that the marker is shown at pick-up", "s", ZERO_OR_MORE)
    hide_seconds: float = parameter(
        5.0, "demo: time that it is hidden before it is shown at drop-off", "s", ZERO_OR_MORE
    )
    pickup_seconds: float = parameter(
        5.0, "service: time that the robot stays at pick-up until it has the object", "s", ZERO_OR_MORE
    )
    resume: bool = parameter(False, "for a respawned node: resume from the state of the one before")
    frame_id: str = parameter("map", "frame of the zones")
    base_frame_id: str = parameter("base_footprint", "the robot's frame, for pose_source tf")
    size: float = parameter(0.2, "edge of the cube", "m", POSITIVE)
    robot_model: str = parameter(
        "mobile_base", "mission: model of the robot in the simulator that carries solid objects"
    )

    def __post_init__(self):
        check_parameters(self)


CONFIG_FILES = {
    "add_markers.yaml": Section(
        "",
        MarkerSettings,
        about="Every parameter of add_markers with its default. Seconds are simulated seconds.",
    )
}
