"""Statements of amcl 1.17: amcl/src/amcl_node.cpp, amcl/cfg/AMCL.cfg and https://wiki.ros.org/amcl.

The input of a case is a run of ``observe_amcl``: ``parameters`` of amcl, the ``steps`` of the robot, how the
map and the frames are (``origin``, ``map_frame``, ``free_value``, ``frames``, ``start``), and the ``fact``.
"""

import math
from typing import Any, Dict, List

import numpy as np
from case import SAME, Case
from node_rig import node_rig

from planar import Pose2

NODE, CFG, PF = "amcl/src/amcl_node.cpp", "amcl/cfg/AMCL.cfg", "amcl/src/amcl/pf/pf.c"
AT_START = {"initial_pose_x": 1.2, "initial_pose_y": 1.5}
SENSE, GLOBALLY, ASK = ["sense"], ["call", "global_localization"], ["call", "request_nomotion_update"]
STANDING = {
    "parameters": AT_START,
    "steps": [SENSE, SENSE, ["late"], ASK, SENSE, ["initialpose", "odom", 1.0, 1.0, 0.0]]
    + [["initialpose", "", 1.2, 1.5, 0.0], SENSE, ["note", "pose", "initial_pose_x"], GLOBALLY, SENSE]
    + [["set_map", "odom", 1.2, 1.5, 0.0]],
}
CORNER = Pose2(4.0, -1.0, 2.2)
TURNED_START = CORNER @ Pose2(1.2, 1.5)


def run(
    name: str,
    fact: str,
    expected: Any,
    official: Any = SAME,
    reason: str = "",
    source: str = NODE,
    **given: Any,
):
    """A case; without further input the robot stands and is asked about everything."""
    return Case(name, source, "amcl", {**(given or STANDING), "fact": fact}, expected, official, reason)


def driven(*steps: List[Any], **parameters: Any) -> Dict[str, Any]:
    """A run in which the robot moves by steps of x, y and yaw, with a scan before and after each."""
    moves = [each for step in steps for each in (["move", *step], SENSE)]
    return {"parameters": {**AT_START, **parameters}, "steps": [SENSE, *moves]}


BROKEN = "0 is refused: the filter divides by it or has no particles"
CODE = "the default in force is reported; AMCL.cfg reports 0, which amcl applies only after a reconfiguration"
REAL, WHOLE, TEXT, FLAG = "double", "int", "str", "bool"
# Type, default, least and greatest value; then those of ours and the reason, where they differ.
PARAMETERS = {
    "min_particles": ((WHOLE, 100, 0, 1000), (WHOLE, 100, 1, 1000), BROKEN),
    "max_particles": ((WHOLE, 5000, 0, 10000), (WHOLE, 5000, 1, 10000), BROKEN),
    "kld_err": ((REAL, 0.01, 0.0, 1.0), (REAL, 0.01, 1e-6, 1.0), BROKEN),
    "kld_z": ((REAL, 0.99, 0.0, 1.0),),
    "update_min_d": ((REAL, 0.2, 0.0, 5.0),),
    "update_min_a": ((REAL, math.pi / 6.0, 0.0, 2.0 * math.pi),),
    "resample_interval": ((WHOLE, 2, 0, 20), (WHOLE, 2, 1, 20), BROKEN),
    "transform_tolerance": ((REAL, 0.1, 0.0, 2.0),),
    "recovery_alpha_slow": ((REAL, 0.0, 0.0, 0.5), (REAL, 0.001, 0.0, 0.5), CODE),
    "recovery_alpha_fast": ((REAL, 0.0, 0.0, 1.0), (REAL, 0.1, 0.0, 1.0), CODE),
    "do_beamskip": ((FLAG, False, False, True),),
    "beam_skip_distance": ((REAL, 0.5, 0.0, 2.0),),
    "beam_skip_threshold": ((REAL, 0.3, 0.0, 1.0),),
    "tf_broadcast": ((FLAG, True, False, True),),
    "force_update_after_initialpose": ((FLAG, False, False, True),),
    "force_update_after_set_map": ((FLAG, False, False, True),),
    "gui_publish_rate": ((REAL, -1.0, -1.0, 100.0),),
    "save_pose_rate": ((REAL, 0.5, -1.0, 10.0),),
    "use_map_topic": ((FLAG, False, False, True),),
    "first_map_only": ((FLAG, False, False, True),),
    "laser_min_range": ((REAL, -1.0, -1.0, 1000.0),),
    "laser_max_range": ((REAL, -1.0, -1.0, 1000.0),),
    "laser_max_beams": ((WHOLE, 30, 0, 250),),
    "laser_z_hit": ((REAL, 0.95, 0.0, 1.0),),
    "laser_z_short": ((REAL, 0.1, 0.0, 1.0),),
    "laser_z_max": ((REAL, 0.05, 0.0, 1.0),),
    "laser_z_rand": ((REAL, 0.05, 0.0, 1.0),),
    "laser_sigma_hit": ((REAL, 0.2, 0.0, 10.0), (REAL, 0.2, 0.001, 10.0), BROKEN),
    "laser_lambda_short": ((REAL, 0.1, 0.0, 10.0),),
    "laser_likelihood_max_dist": ((REAL, 2.0, 0.0, 20.0),),
    "laser_model_type": ((TEXT, "likelihood_field", "", ""),),
    "odom_model_type": ((TEXT, "diff", "", ""),),
    **{f"odom_alpha{number}": ((REAL, 0.2, 0.0, 10.0),) for number in (1, 2, 3, 4, 5)},
    "odom_frame_id": ((TEXT, "odom", "", ""),),
    "base_frame_id": ((TEXT, "base_link", "", ""),),
    "global_frame_id": ((TEXT, "map", "", ""),),
    "restore_defaults": ((FLAG, False, False, True),),
}


def parameter(name: str) -> Case:
    """The case of a line of AMCL.cfg."""
    official, *difference = PARAMETERS[name]
    ours, reason = difference or (official, "")
    expected, others = list(ours), list(official) if difference else SAME
    return run(f"parameter_{name}", f"parameters.{name}", expected, others, reason, CFG)


STANDS = [
    run(
        "amcl_pose_is_a_pose_with_covariance",
        "publishes./amcl_pose",
        "geometry_msgs/PoseWithCovarianceStamped",
    ),
    run("particlecloud_is_a_pose_array", "publishes./particlecloud", "geometry_msgs/PoseArray"),
    run("the_transform_is_published_on_tf", "publishes./tf", "tf2_msgs/TFMessage"),
    run("diagnostics_are_published", "publishes./diagnostics", "diagnostic_msgs/DiagnosticArray"),
    run(
        "scan_and_initialpose_are_subscribed_to",
        "subscribes",
        {
            "/scan": "sensor_msgs/LaserScan",
            "/initialpose": "geometry_msgs/PoseWithCovarianceStamped",
            "/tf": "tf2_msgs/TFMessage",
            "/tf_static": "tf2_msgs/TFMessage",
        },
    ),
    *(
        run(f"{name}_is_a_service", "services has /" + name, True)
        for name in (
            "global_localization",
            "request_nomotion_update",
            "set_map",
            "amcl/set_parameters",
            "amcl/get_loggers",
        )
    ),
    run("the_pose_has_the_global_frame", "senses.0.pose_frame", "map"),
    run("the_pose_has_the_stamp_of_the_scan", "senses.0.has_scan_stamp", True),
    run("the_covariance_has_x_y_and_yaw", "senses.0.covariance", [0, 1, 6, 7, 35]),
    run("the_first_scan_publishes_a_pose", "senses.0.pose is known", True),
    run("the_initial_pose_is_that_of_the_parameters", "senses.0.error < 0.1", True),
    run("the_initial_deviation_is_half_a_metre", "senses.0.spread", 0.5),
    run("the_first_cloud_has_max_particles", "senses.0.cloud", 5000),
    run("the_cloud_has_the_global_frame", "senses.0.cloud_frame", "map"),
    run("the_transform_is_post_dated_by_the_tolerance", "senses.0.tf", ["map", "odom", 0.1]),
    run("a_robot_that_stands_gets_no_new_pose", "senses.1.pose", None),
    run("a_robot_that_stands_gets_no_new_cloud", "senses.1.cloud", None),
    run("each_scan_sends_the_transform", "senses.1.tf", ["map", "odom", 0.1]),
    run("amcl_pose_is_latched", "values.latched_amcl_pose", True),
    run("particlecloud_is_latched", "values.latched_particlecloud", True),
    run("request_nomotion_update_forces_an_update", "senses.2.pose is known", True),
    run(
        "an_initial_pose_of_another_frame_is_ignored",
        'log has Ignoring initial pose in frame "odom"; initial poses must be in the global frame, "map"',
        True,
    ),
    run(
        "an_initial_pose_without_frame_is_taken_with_a_warning",
        "log has Received initial pose with empty frame_id.  You should always supply a frame_id.",
        True,
    ),
    run("the_initial_pose_taken_is_logged", "log has : 1.200 1.500 0.000", True),
    run("the_covariance_of_the_initial_pose_is_taken", "senses.3.deviations", [0.1, 0.1, 0.1]),
    run("the_pose_is_saved_to_the_parameters", "values.pose > 1.0", True),
    run("global_localization_draws_max_particles", "senses.4.cloud", 5000),
    run("global_localization_draws_over_the_whole_map", "senses.4.spread > 1.5", True),
    run("global_localization_is_logged", "log has Initializing with uniform distribution", True),
    run("set_map_succeeds_whatever_the_frame_of_its_pose", "values.set_map", True),
    run("the_map_that_is_received_is_logged", "log has Received a 160 X 72 map @ 0.050 m/pix", True),
    run("the_map_is_requested", "log has Requesting the map...", True),
    run("the_status_is_standard_deviation", "diagnostics has amcl: Standard deviation", True),
    run("the_status_is_of_hardware_none", "diagnosis.0.0", "None"),
    run(
        "the_status_has_the_deviations_and_their_limits",
        "diagnosis.0.1",
        ["std_warn_level_x", "std_warn_level_y", "std_warn_level_yaw", "std_x", "std_y", "std_yaw"],
    ),
    run("the_pose_is_saved_when_the_node_is_interrupted", "values.saved_initial_pose_a is known", True),
    run("an_interrupted_node_exits_with_0", "exit_code", 0),
    run(
        "the_pose_in_a_replaced_map_is_not_saved",
        "values.saved_initial_cov_xx < 1.0",
        True,
        False,
        "the last pose is one in the map before set_map",
    ),
]

DRIVES = driven((0.15, 0.15, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.5), (0.0, 0.0, 0.1), resample_interval=1)
THRICE = driven(*6 * [(0.3, 0.0, 0.0)], resample_interval=3)
FEW = driven((0.3, 0.0, 0.0), min_particles=150, max_particles=150, resample_interval=1)
CONVERGED = {
    "parameters": {
        **AT_START,
        "initial_cov_xx": 0.01,
        "initial_cov_yy": 0.01,
        "initial_cov_aa": 0.01,
        "resample_interval": 1,
        "min_particles": 300,
        "max_particles": 4000,
    },
    "steps": driven((0.3, 0.0, 0.0), (0.3, 0.0, 0.0))["steps"],
}
NAMED = {
    "parameters": {
        **AT_START,
        "odom_frame_id": "/odom",
        "base_frame_id": "/base",
        "global_frame_id": "/world",
        "transform_tolerance": 0.5,
        "save_pose_rate": -1.0,
    },
    "frames": {"base_frame": "base"},
    "map_frame": "world",
    "steps": [
        SENSE,
        SENSE,
        SENSE,
        ["note", "pose", "initial_pose_y"],
        ["initialpose", "/world", 1.2, 1.5, 0.0],
        SENSE,
    ],
}
UNKNOWN_MODELS = {
    "parameters": {**AT_START, "odom_model_type": "legs", "laser_model_type": "radar", "tf_broadcast": False},
    "steps": [SENSE],
}
ON_TOPIC = {
    "parameters": {**AT_START, "use_map_topic": True, "first_map_only": True},
    "steps": [["publish_map", "elsewhere"], SENSE, ["publish_map", "map"]],
}
HALF_FREE = {"parameters": AT_START, "free_value": 50, "steps": [SENSE, GLOBALLY, SENSE]}
TURNED = {
    "parameters": {
        "initial_pose_x": TURNED_START.x,
        "initial_pose_y": TURNED_START.y,
        "initial_pose_a": TURNED_START.yaw,
        "resample_interval": 1,
    },
    "origin": CORNER.as_array().tolist(),
    "start": TURNED_START.as_array().tolist(),
    "steps": driven(*3 * [(0.3, 0.0, 0.0)])["steps"],
}
PANNING = {
    "parameters": {**AT_START, "resample_interval": 1, "initial_cov_aa": 0.01},
    "steps": [
        step
        for yaw in np.radians([0, 40, 80, 120, 160]).tolist()
        for step in (["turn_mount", yaw], ["move", 0.25, 0.0, 0.0], SENSE)
    ],
}
BAD_SCAN = {"parameters": AT_START, "steps": [["scan", {"range_max": -1.0}], SENSE]}
SILENT = {"parameters": {**AT_START, "initial_pose_a": math.nan}, "steps": [["wait", 16.5]]}

MOVES = [
    run("update_min_d_is_of_x_and_y_each", "senses.1.pose", None, **DRIVES),
    run("update_min_d_passed_updates", "senses.2.pose is known", True, **DRIVES),
    run("update_min_a_not_passed_does_not_update", "senses.3.pose", None, **DRIVES),
    run("update_min_a_passed_updates", "senses.4.pose is known", True, **DRIVES),
    run("a_pose_is_published_when_resampled", "senses.2.pose is known", True, **THRICE),
    run("resample_interval_counts_updates", "senses.1.pose", None, **THRICE),
    run("resample_interval_counts_updates_after_a_resampling", "senses.4.pose", None, **THRICE),
    run("each_update_publishes_a_cloud", "senses.1.cloud", 5000, **THRICE),
    run("max_particles_is_the_first_number", "senses.0.cloud", 150, **FEW),
    run("min_particles_holds_after_resampling", "senses.1.cloud", 150, **FEW),
    run("kld_sampling_reduces_the_particles", "senses.2.cloud < 4000", True, source=PF, **CONVERGED),
    run("kld_sampling_keeps_min_particles", "senses.2.cloud > 299", True, source=PF, **CONVERGED),
    run("initial_cov_is_the_first_spread", "senses.0.spread", 0.1, **CONVERGED),
    run("frames_lose_their_leading_slash", "senses.0.tf", ["world", "odom", 0.5], **NAMED),
    run("the_pose_has_the_named_frame", "senses.0.pose_frame", "world", **NAMED),
    run("an_initial_pose_may_have_a_leading_slash", "senses.3.pose is known", True, **NAMED),
    run("a_negative_save_pose_rate_saves_nothing_on_the_way", "values.pose", 1.5, **NAMED),
    run(
        "an_unknown_motion_model_is_diff",
        'log has Unknown odom model type "legs"; defaulting to diff model',
        True,
        **UNKNOWN_MODELS,
    ),
    run(
        "an_unknown_sensor_model_is_likelihood_field",
        'log has Unknown laser model type "radar"; defaulting to likelihood_field model',
        True,
        **UNKNOWN_MODELS,
    ),
    run("tf_broadcast_false_sends_no_transform", "senses.0.tf", None, **UNKNOWN_MODELS),
    run("tf_broadcast_false_still_publishes_poses", "senses.0.pose is known", True, **UNKNOWN_MODELS),
    run("use_map_topic_subscribes_to_the_map", "subscribes./map", "nav_msgs/OccupancyGrid", **ON_TOPIC),
    run("use_map_topic_is_logged", "log has Subscribed to map topic.", True, **ON_TOPIC),
    run(
        "a_map_of_another_frame_is_taken_with_a_warning",
        "log has Frame_id of map received:'elsewhere' doesn't match global_frame_id:'map'. "
        "This could cause issues with reading published topics",
        True,
        **ON_TOPIC,
    ),
    run("a_map_of_another_frame_is_used", "senses.0.pose is known", True, **ON_TOPIC),
    run("only_cells_of_0_are_free", "senses.1.right_half", 0.0, **HALF_FREE),
    run(
        "the_yaw_of_the_map_is_honoured",
        "senses.3.error < 0.15",
        True,
        False,
        "map_server documents the yaw; amcl ignores it",
        **TURNED,
    ),
    run("the_mount_of_a_laser_may_turn", "senses.4.error < 0.15", True, **PANNING),
    run("a_scan_of_negative_range_max_is_ignored", "senses.0.pose", None, **BAD_SCAN),
    run(
        "after_an_invalid_scan_the_next_is_used",
        "senses.1.pose is known",
        True,
        False,
        "the pose forced at the first scan is lost with that scan",
        **BAD_SCAN,
    ),
    run(
        "missing_scans_are_warned_of_after_15_s",
        "log has No laser scan received (and thus no pose updates have been published) for ",
        True,
        **SILENT,
    ),
    run(
        "the_warning_names_the_topic",
        "log has Verify that data is being published on the /scan topic.",
        True,
        **SILENT,
    ),
    run(
        "nan_in_the_initial_pose_is_ignored_with_a_warning",
        "log has ignoring NAN in initial pose Yaw",
        True,
        **SILENT,
    ),
]

CASES = [parameter(name) for name in PARAMETERS] + STANDS + MOVES
RIGS = {"amcl": node_rig("amcl_lite.ros.node", "amcl", "amcl", "observe_amcl")}
