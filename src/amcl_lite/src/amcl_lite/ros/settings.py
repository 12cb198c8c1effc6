"""The settings of the node: from the parameter server, and as dynamic_reconfigure changes them."""

from typing import Any, Mapping, Sequence

import rospy

from amcl_lite.config import MOTION_MODELS, SENSOR_MODELS, InitialPose, NodeSettings, settings_warnings
from amcl_lite.ineffective import parameters_without_effect
from planar.config.parameters import official_names
from planar.config.settings import settings_from
from planar_ros.node.parameters import RESTORE, read_settings


def read_node_settings() -> NodeSettings:
    """The settings on the parameter server, with advice in the log. Raises SettingsError."""
    _replace_unknown("odom_model_type", MOTION_MODELS, "odom model type", "diff model")
    _replace_unknown("laser_model_type", SENSOR_MODELS, "laser model type", "likelihood_field model")
    settings = read_settings(
        NodeSettings,
        official_names(NodeSettings),
        ignore=(*official_names(InitialPose), RESTORE),
        without_effect=parameters_without_effect,
    )
    for line in settings_warnings(settings):
        rospy.logwarn(line)
    return settings


def changed_settings(running: NodeSettings, values: Mapping[str, Any]) -> NodeSettings:
    """The running settings with other values, by official name. Raises SettingsError."""
    if values["min_particles"] > values["max_particles"]:
        rospy.logwarn(
            "You've set min_particles to be greater than max particles, this isn't allowed so they'll be "
            "set to be equal."
        )
        values = {**values, "max_particles": values["min_particles"]}
    names = official_names(NodeSettings)
    in_force = {name: getattr(running, field) for name, field in names.items()}
    settings, _ = settings_from(NodeSettings, {**in_force, **values}, names)
    return settings


def _replace_unknown(name: str, known: Sequence[str], what: str, default: str) -> None:
    """amcl warns of an unknown model and takes its first one."""
    value = rospy.get_param("~" + name, known[0])
    if isinstance(value, str) and value not in known:
        rospy.logwarn('Unknown %s "%s"; defaulting to %s', what, value, default)
        rospy.set_param("~" + name, known[0])
