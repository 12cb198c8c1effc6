"""Parameters of localization that have no effect with the values of others."""

from typing import Dict, Iterable, Tuple

from amcl_lite.config import STRICT_COMPAT_SETTINGS, NodeSettings
from planar.config.parameters import parameters_of

OF_BEAM_MODEL = "laser_z_short", "laser_z_max", "laser_lambda_short"
OF_BEAM_SKIPPING = "beam_skip_distance", "beam_skip_threshold", "beam_skip_error_threshold"


def parameters_without_effect(settings: NodeSettings) -> Dict[str, str]:
    """Find the parameters that have no effect, although their value is not the default.

    The official amcl does not use them in these cases either, except for ``strict_compat``, which it does not
    have. Plugins are given all parameters.

    Args:
        settings: All parameters.

    Returns:
        The reason for each, by the official name.
    """
    changed = {
        each.name
        for each in parameters_of(NodeSettings)
        if getattr(settings, each.field) != each.default or each.name in STRICT_COMPAT_SETTINGS
    }
    unused: Dict[str, str] = {}
    for names, reason in _unused(settings):
        for name in changed.intersection(names):
            unused.setdefault(name, reason)
    return unused


def _unused(settings: NodeSettings) -> Iterable[Tuple[Iterable[str], str]]:
    """Yield names of parameters that have no effect, and the reason."""
    yield ("gui_publish_rate",), "amcl does not use it either"
    if settings.strict_compat:
        yield STRICT_COMPAT_SETTINGS, "strict_compat is set"
    if settings.motion_model.startswith("diff") and not settings.motion_plugin:
        yield ("odom_alpha5",), f"odom_model_type is {settings.motion_model}"
    if not settings.tf_broadcast:
        yield ("transform_tolerance",), "tf_broadcast is not set"
    if not settings.use_map_topic:
        yield ("first_map_only",), "use_map_topic is not set"
    if settings.sensor_plugin:
        return  # it is given all parameters
    if settings.sensor_model != "beam":
        yield OF_BEAM_MODEL, f"laser_model_type is {settings.sensor_model}"
    if settings.sensor_model != "likelihood_field_prob":
        yield ("do_beamskip", *OF_BEAM_SKIPPING), f"laser_model_type is {settings.sensor_model}"
    if not settings.beam_skip:
        yield OF_BEAM_SKIPPING, "do_beamskip is not set"
