from pathlib import Path

import pytest
import yaml

from amcl_lite.config import InitialPose, LocalizerSettings, NodeSettings, settings_warnings
from planar import SettingsError
from planar.config.parameters import official_names, parameters_of
from planar.config.settings import settings_from

CONFIG = Path(__file__).resolve().parents[1] / "config"

# contracts of amcl 1.17: the defaults of its code
OFFICIAL = {
    "use_map_topic": False,
    "first_map_only": False,
    "gui_publish_rate": -1.0,
    "save_pose_rate": 0.5,
    "laser_min_range": -1.0,
    "laser_max_range": -1.0,
    "laser_max_beams": 30,
    "min_particles": 100,
    "max_particles": 5000,
    "kld_err": 0.01,
    "kld_z": 0.99,
    "odom_alpha1": 0.2,
    "odom_alpha2": 0.2,
    "odom_alpha3": 0.2,
    "odom_alpha4": 0.2,
    "odom_alpha5": 0.2,
    "odom_model_type": "diff",
    "laser_model_type": "likelihood_field",
    "laser_z_hit": 0.95,
    "laser_z_short": 0.1,
    "laser_z_max": 0.05,
    "laser_z_rand": 0.05,
    "laser_sigma_hit": 0.2,
    "laser_lambda_short": 0.1,
    "laser_likelihood_max_dist": 2.0,
    "do_beamskip": False,
    "beam_skip_distance": 0.5,
    "beam_skip_threshold": 0.3,
    "beam_skip_error_threshold": 0.9,
    "update_min_d": 0.2,
    "update_min_a": 0.5235987755982988,
    "resample_interval": 2,
    "selective_resampling": False,
    "transform_tolerance": 0.1,
    "recovery_alpha_slow": 0.001,
    "recovery_alpha_fast": 0.1,
    "tf_broadcast": True,
    "force_update_after_initialpose": False,
    "force_update_after_set_map": False,
    "odom_frame_id": "odom",
    "base_frame_id": "base_link",
    "global_frame_id": "map",
    "std_warn_level_x": 0.2,
    "std_warn_level_y": 0.2,
    "std_warn_level_yaw": 0.1,
    "bag_scan_period": -1.0,
    "initial_pose_x": 0.0,
    "initial_pose_y": 0.0,
    "initial_pose_a": 0.0,
    "initial_cov_xx": 0.25,
    "initial_cov_yy": 0.25,
    "initial_cov_aa": 0.06853891945200942,
}


def test_every_official_parameter_has_its_official_default():
    ours = {each.name: each.default for kind in (NodeSettings, InitialPose) for each in parameters_of(kind)}
    assert {name: ours.get(name) for name in OFFICIAL} == OFFICIAL


def test_settings_that_mislead_are_pointed_out():
    assert settings_warnings(NodeSettings()) == []
    assert "odometry" in settings_warnings(NodeSettings(beams=1))[0]
    (line,) = settings_warnings(NodeSettings(recovery_alpha_slow=0.2))
    assert line.startswith("recovery_alpha_slow above recovery_alpha_fast")


def test_strict_compatibility_brings_back_amcls_mistakes():
    strict = NodeSettings(strict_compat=True)
    assert strict.kld_quantile == 0.99 and not strict.refine_pose and strict.resample_method == "multinomial"
    assert NodeSettings().kld_quantile == pytest.approx(2.326, abs=1e-3)


def test_the_turtlebot_preset_is_understood():
    preset = yaml.safe_load((CONFIG / "turtlebot.yaml").read_text())
    settings, unknown = settings_from(NodeSettings, preset, official_names(NodeSettings))
    assert unknown == []
    assert (settings.max_particles, settings.base_frame) == (2000, "base_footprint")


@pytest.mark.parametrize(
    "name, value, complaint",
    [
        ("laser_z_hit", 1.5, "/amcl/laser_z_hit must be between 0 and 1"),
        ("laser_max_beams", "many", "/amcl/laser_max_beams must be a whole number"),
        ("resample_interval", 0, "/amcl/resample_interval must be"),
        ("min_particles", 9000, "/amcl/min_particles must be at most max_particles"),
        ("odom_alpha1", -0.1, "/amcl/odom_alpha1 must be"),
    ],
)
def test_a_senseless_value_is_refused_by_its_official_name(name, value, complaint):
    with pytest.raises(SettingsError, match=complaint):
        settings_from(NodeSettings, {name: value}, official_names(NodeSettings), where="/amcl/")


def test_unknown_models_are_refused():
    with pytest.raises(SettingsError, match="motion_model"):
        LocalizerSettings(motion_model="hover")


def test_the_initial_covariance_is_diagonal():
    assert InitialPose().covariance.diagonal().tolist() == [0.25, 0.25, 0.06853891945200942]
