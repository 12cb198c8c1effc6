"""Settings of localization: every parameter once, with its official name, default, bounds and meaning.

Names and defaults are those of amcl 1.17 (the defaults of its code, where its cfg file differs).
"""

import dataclasses
import math
from dataclasses import dataclass
from typing import Any, Dict, Tuple

import numpy as np

from planar import Pose2
from planar.settings import check

MOTION_MODELS = ("diff", "omni", "diff-corrected", "omni-corrected")
SENSOR_MODELS = ("likelihood_field", "likelihood_field_prob", "beam")


def _parameter(name: str, default: Any, meaning: str, low: float = -math.inf, high: float = math.inf) -> Any:
    return dataclasses.field(
        default=default, metadata={"name": name, "meaning": meaning, "low": low, "high": high}
    )


@dataclass(frozen=True)
class LocalizerSettings:
    """What the particle filter works with; metres and radians."""

    min_particles: int = _parameter("min_particles", 100, "fewest particles (KLD-sampling's floor)", 1)
    max_particles: int = _parameter(
        "max_particles", 5000, "most particles, and how many a new start is made of", 1
    )
    kld_error: float = _parameter(
        "kld_err", 0.01, "largest error between the true and the sampled distribution", 1e-6, 1.0
    )
    kld_z: float = _parameter("kld_z", 0.99, "upper quantile of the standard normal, used as z itself", 0.0)
    motion_model: str = _parameter("odom_model_type", "diff", "one of " + ", ".join(MOTION_MODELS))
    rotation_from_rotation: float = _parameter("odom_alpha1", 0.2, "rotation noise caused by rotation", 0.0)
    rotation_from_translation: float = _parameter(
        "odom_alpha2", 0.2, "rotation noise caused by translation, rad per m", 0.0
    )
    translation_from_translation: float = _parameter(
        "odom_alpha3", 0.2, "translation noise caused by translation", 0.0
    )
    translation_from_rotation: float = _parameter(
        "odom_alpha4", 0.2, "translation noise caused by rotation, m per rad", 0.0
    )
    strafe_from_translation: float = _parameter(
        "odom_alpha5", 0.2, "sideways noise caused by translation (omni models only)", 0.0
    )
    sensor_model: str = _parameter(
        "laser_model_type", "likelihood_field", "one of " + ", ".join(SENSOR_MODELS)
    )
    beams: int = _parameter(
        "laser_max_beams", 30, "evenly spaced beams used of each scan; fewer than 2 disables the sensor", 0
    )
    laser_min_range: float = _parameter(
        "laser_min_range", -1.0, "readings up to this, m, are ignored; -1: the scan's own limit"
    )
    laser_max_range: float = _parameter(
        "laser_max_range", -1.0, "readings from this on, m, are ignored; -1: the scan's own limit"
    )
    z_hit: float = _parameter("laser_z_hit", 0.95, "share of beams that meet what the map shows", 0.0, 1.0)
    z_short: float = _parameter(
        "laser_z_short", 0.1, "share of beams that are cut short (beam model)", 0.0, 1.0
    )
    z_max: float = _parameter("laser_z_max", 0.05, "share of beams without return (beam model)", 0.0, 1.0)
    z_rand: float = _parameter("laser_z_rand", 0.05, "share of random readings", 0.0, 1.0)
    sigma_hit: float = _parameter("laser_sigma_hit", 0.2, "standard deviation of a hit, m", 1e-3)
    lambda_short: float = _parameter(
        "laser_lambda_short", 0.1, "decay of short readings (beam model), 1/m", 0.0
    )
    likelihood_max_distance: float = _parameter(
        "laser_likelihood_max_dist", 2.0, "largest distance to an obstacle that is told apart, m", 0.0
    )
    beam_skip: bool = _parameter(
        "do_beamskip",
        False,
        "leave out beams that most particles cannot explain (likelihood_field_prob only)",
    )
    beam_skip_distance: float = _parameter(
        "beam_skip_distance", 0.5, "a beam that ends nearer than this to an obstacle is explained, m", 0.0
    )
    beam_skip_threshold: float = _parameter(
        "beam_skip_threshold", 0.3, "share of particles that must explain a beam for it to be used", 0.0, 1.0
    )
    beam_skip_error_threshold: float = _parameter(
        "beam_skip_error_threshold", 0.9, "if this share of beams would be left out, all are used", 0.0, 1.0
    )
    update_min_distance: float = _parameter(
        "update_min_d", 0.2, "motion along x or along y of the odometry frame that causes an update, m", 0.0
    )
    update_min_angle: float = _parameter(
        "update_min_a", math.pi / 6.0, "rotation that causes an update, rad", 0.0
    )
    resample_interval: int = _parameter("resample_interval", 2, "filter updates per resampling", 1)
    selective_resampling: bool = _parameter(
        "selective_resampling", False, "resample only if fewer than half the particles are effective"
    )
    recovery_alpha_slow: float = _parameter(
        "recovery_alpha_slow", 0.001, "decay of the slow average of weights; 0: no recovery", 0.0, 1.0
    )
    recovery_alpha_fast: float = _parameter(
        "recovery_alpha_fast", 0.1, "decay of the fast average of weights; 0: no recovery", 0.0, 1.0
    )

    def __post_init__(self):
        for field in dataclasses.fields(self):
            value, low, high = getattr(self, field.name), field.metadata["low"], field.metadata["high"]
            if isinstance(value, (int, float)):
                check(low <= value <= high, field.name, f"between {low:g} and {high:g}", value)
        check(
            self.motion_model in MOTION_MODELS, "motion_model", f"one of {MOTION_MODELS}", self.motion_model
        )
        check(
            self.sensor_model in SENSOR_MODELS, "sensor_model", f"one of {SENSOR_MODELS}", self.sensor_model
        )
        check(
            self.min_particles <= self.max_particles,
            "min_particles",
            f"at most max_particles ({self.max_particles})",
            self.min_particles,
        )


@dataclass(frozen=True)
class NodeSettings(LocalizerSettings):
    """What the node needs besides."""

    odom_frame: str = _parameter("odom_frame_id", "odom", "frame of the odometry")
    base_frame: str = _parameter("base_frame_id", "base_link", "frame of the robot")
    map_frame: str = _parameter("global_frame_id", "map", "frame of the map")
    use_map_topic: bool = _parameter(
        "use_map_topic", False, "take the map from the topic map, not from the service static_map"
    )
    first_map_only: bool = _parameter("first_map_only", False, "ignore all but the first map on the topic")
    gui_publish_rate: float = _parameter("gui_publish_rate", -1.0, "accepted, without effect (as in amcl)")
    save_pose_rate: float = _parameter(
        "save_pose_rate", 0.5, "how often the pose goes to the parameter server, Hz; 0 or less: never"
    )
    transform_tolerance: float = _parameter(
        "transform_tolerance", 0.1, "how far map->odom is post-dated, s", 0.0
    )
    tf_broadcast: bool = _parameter("tf_broadcast", True, "publish map->odom")
    force_update_after_initialpose: bool = _parameter(
        "force_update_after_initialpose", False, "update without motion after a pose on initialpose"
    )
    force_update_after_set_map: bool = _parameter(
        "force_update_after_set_map", False, "update without motion after a call of set_map"
    )
    std_warn_level_x: float = _parameter("std_warn_level_x", 0.2, "diagnostics warn above this, m", 0.0)
    std_warn_level_y: float = _parameter("std_warn_level_y", 0.2, "diagnostics warn above this, m", 0.0)
    std_warn_level_yaw: float = _parameter("std_warn_level_yaw", 0.1, "diagnostics warn above this, rad", 0.0)
    bag_scan_period: float = _parameter(
        "bag_scan_period", -1.0, "pause between scans with --run-from-bag, s; -1: none"
    )
    seed: int = _parameter(
        "seed", 0, "of all chance; the same seed gives the same draws; -1: from the system", -1
    )


@dataclass(frozen=True)
class InitialPose:
    """Where a filter starts when a map arrives; read anew at each map, written by pose saving."""

    x: float = _parameter("initial_pose_x", 0.0, "m")
    y: float = _parameter("initial_pose_y", 0.0, "m")
    yaw: float = _parameter("initial_pose_a", 0.0, "rad")
    covariance_xx: float = _parameter("initial_cov_xx", 0.25, "m^2", 0.0)
    covariance_yy: float = _parameter("initial_cov_yy", 0.25, "m^2", 0.0)
    covariance_aa: float = _parameter("initial_cov_aa", (math.pi / 12.0) ** 2, "rad^2", 0.0)

    @property
    def pose(self) -> Pose2:
        return Pose2(self.x, self.y, self.yaw)

    @property
    def covariance(self) -> np.ndarray:
        """(3, 3), diagonal."""
        return np.diag((self.covariance_xx, self.covariance_yy, self.covariance_aa))


def official_names(kind: type) -> Dict[str, str]:
    """The table official parameter name -> field of a settings class."""
    return {field.metadata["name"]: field.name for field in dataclasses.fields(kind)}


def defaults() -> Dict[str, Tuple[Any, str]]:
    """Every parameter of the node by its official name: default and meaning."""
    return {
        field.metadata["name"]: (field.default, field.metadata["meaning"])
        for kind in (NodeSettings, InitialPose)
        for field in dataclasses.fields(kind)
    }
