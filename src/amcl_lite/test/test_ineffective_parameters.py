"""Each parameter changes what the filter does, or is named as one without effect."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from amcl_lite import Localizer
from amcl_lite.config import LocalizerSettings, NodeSettings
from amcl_lite.ineffective import parameters_without_effect
from planar import Pose2, Scan, grid_from_picture
from planar.config.parameters import official_names, parameters_of
from planar.config.settings import settings_from
from planar.geometry.ray_casting import cast_rays

PRESETS = Path(__file__).resolve().parents[1] / "config"
ROOM = """
####################
#..................#
#..................#
#.......###........#
#.......###........#
#..................#
#............#.....#
#............#.....#
####################
"""
BEAMS, RANGE_MAX = 90, 1.5
BASE = NodeSettings(
    min_particles=60,
    max_particles=300,
    kld_error=0.05,
    update_min_distance=0.1,
    update_min_angle=0.1,
    resample_interval=1,
    recovery_alpha_slow=0.2,
    recovery_alpha_fast=0.5,
    update_when_still=0.0,
    refine_pose=False,
)
SKIPPING = replace(
    BASE,
    sensor_model="likelihood_field_prob",
    beam_skip=True,
    beam_skip_distance=0.1,
    beam_skip_threshold=0.9,
)
CONTEXTS = {
    "field": BASE,
    "field, refined": replace(BASE, refine_pose=True),
    "beam": replace(BASE, sensor_model="beam", refine_pose=True),
    "prob": SKIPPING,
    "omni": replace(BASE, motion_model="omni"),
    "still": replace(BASE, update_when_still=0.6),
    "strict": replace(BASE, strict_compat=True),
}
# Parameters of recovery, where the scans of this drive fit too well for it.
FITTING = {"prob": {"recovery_alpha_slow", "recovery_alpha_fast"}, "still": {"recovery_alpha_slow"}}
# Another value for each parameter of the filter.
OTHER = {
    "min_particles": 290,
    "max_particles": 100,
    "kld_err": 0.2,
    "kld_z": 0.5,
    "odom_model_type": "diff-corrected",
    **{f"odom_alpha{number}": 0.05 for number in (1, 2, 3, 4, 5)},
    "laser_model_type": "beam",
    "laser_max_beams": 12,
    "laser_min_range": 1.0,
    "laser_max_range": 1.0,
    "laser_z_hit": 0.5,
    "laser_z_short": 0.4,
    "laser_z_max": 0.4,
    "laser_z_rand": 0.4,
    "laser_sigma_hit": 0.05,
    "laser_lambda_short": 2.0,
    "laser_likelihood_max_dist": 0.2,
    "do_beamskip": True,
    "beam_skip_distance": 0.3,
    "beam_skip_threshold": 0.2,
    "beam_skip_error_threshold": 0.02,
    "update_min_d": 0.4,
    "update_min_a": 0.4,
    "resample_interval": 3,
    "selective_resampling": True,
    "recovery_alpha_slow": 0.4,
    "recovery_alpha_fast": 0.9,
    "resample_method": "multinomial",
    "refine_pose": True,
    "update_when_still": 2.0,
    "strict_compat": True,
}
# By test_custom_models.py and test_localizer.py.
CHECKED_ELSEWHERE = {"motion_plugin", "sensor_plugin", "recover_when_lost"}
FIELDS = official_names(LocalizerSettings)


def particles(settings):
    """Particles after a short drive with a stop, at the end beside a person who is not in the map."""
    grid = grid_from_picture(ROOM, 0.05, scale=5)
    pose, odometry, rng = Pose2(1.0, 0.8, 0.2), Pose2(), np.random.default_rng(3)
    angles = -math.pi + np.arange(BEAMS) * 2.0 * math.pi / BEAMS
    localizer = Localizer(grid, settings, np.random.default_rng(1))
    localizer.set_pose(pose, np.diag((0.02, 0.02, 0.01)))
    drive, turn, stop = Pose2(0.16, 0.02, 0.03), Pose2(0.02, 0.0, 0.2), Pose2()
    steps = [drive, drive, turn, stop, stop, drive, turn, drive, drive]
    for number, step in enumerate(steps):
        pose, odometry = pose @ step, odometry @ Pose2(step.x * 1.1, step.y, step.yaw + 0.02)
        ranges = cast_rays(grid, pose, angles, RANGE_MAX) + rng.normal(0.0, 0.02, BEAMS)
        if number > 3:
            ranges[number : number + 30] = 0.6
        ranges[ranges >= RANGE_MAX] = RANGE_MAX
        scan = Scan(
            float(number), -math.pi, 2.0 * math.pi / BEAMS, ranges.astype(np.float32), 0.05, RANGE_MAX
        )
        localizer.update(odometry, scan)
    return localizer.particles


def outcome(settings):
    found = particles(settings)
    return found.poses.tobytes(), found.weights.tobytes()


def test_each_parameter_of_the_filter_is_checked():
    filtering = {each.name for each in parameters_of(LocalizerSettings)}
    assert filtering - OTHER.keys() == CHECKED_ELSEWHERE


@pytest.mark.parametrize("context", CONTEXTS)
def test_a_parameter_has_an_effect_unless_it_is_named(context):
    settings = CONTEXTS[context]
    before, silent, wrongly_named = outcome(settings), [], []
    for name, value in OTHER.items():
        changed = replace(settings, **{FIELDS[name]: value})
        has_effect = outcome(changed) != before
        named = parameters_without_effect(changed)
        if not has_effect and name not in named and getattr(settings, FIELDS[name]) != value:
            silent.append(name)
        if has_effect and name in named:
            wrongly_named.append(name)
    assert (set(silent) - FITTING.get(context, set()), wrongly_named) == (set(), [])


def test_defaults_are_not_named():
    assert parameters_without_effect(NodeSettings()) == {}


@pytest.mark.parametrize(
    "changed, name, reason",
    [
        ({"gui_publish_rate": 5.0}, "gui_publish_rate", "amcl does not use it either"),
        ({"z_short": 0.2}, "laser_z_short", "laser_model_type is likelihood_field"),
        ({"beam_skip": True}, "do_beamskip", "laser_model_type is likelihood_field"),
        ({"strafe_from_translation": 0.1}, "odom_alpha5", "odom_model_type is diff"),
        (
            {"tf_broadcast": False, "transform_tolerance": 0.5},
            "transform_tolerance",
            "tf_broadcast is not set",
        ),
        ({"first_map_only": True}, "first_map_only", "use_map_topic is not set"),
    ],
)
def test_the_reason_names_the_parameter_that_decides(changed, name, reason):
    named = parameters_without_effect(replace(NodeSettings(), **changed))
    assert [*named] == [name] and reason in named[name]


@pytest.mark.parametrize("preset", ["turtlebot.yaml"])
def test_the_presets_set_only_what_has_an_effect(preset):
    values = yaml.safe_load((PRESETS / preset).read_text())
    settings, _ = settings_from(NodeSettings, values, official_names(NodeSettings))
    assert parameters_without_effect(settings) == {}
