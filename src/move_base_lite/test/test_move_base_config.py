"""Conversion of official parameters to settings; invalid and unknown ones are reported."""

from dataclasses import fields
from pathlib import Path

import pytest
import yaml

from move_base_lite import Navigator, NavigatorSettings, load_settings, settings_from_parameters
from move_base_lite.config import MoveBaseSettings
from move_base_lite.control import DwaSettings, MppiSettings
from move_base_lite.costmap import CostmapSettings
from move_base_lite.costmap.layers.inflation import InflationSettings
from move_base_lite.costmap.layers.obstacles import ObstacleSettings, SourceSettings
from move_base_lite.costmap.layers.static import StaticSettings
from move_base_lite.parameters import merged
from move_base_lite.planning import NavfnSettings
from move_base_lite.recovery import MoveSlowSettings, RotateSettings
from planar import Pose2, SettingsError, grid_from_picture

DWA = {"base_local_planner": "dwa_local_planner/DWAPlannerROS"}
MERGED_OFTEN = "k0: &k0 {a: 1}\n" + "".join(
    f"k{i}: &k{i} {{<<: [*k{i - 1}, *k{i - 1}]}}\n" for i in range(1, 40)
)
CONFIG = Path(__file__).resolve().parents[1] / "config"
DOCUMENTED = yaml.safe_load((CONFIG / "move_base_lite.yaml").read_text())


@pytest.mark.parametrize(
    "kind, keys, not_listed",
    [
        (MoveBaseSettings, [], set()),
        (NavfnSettings, ["NavfnROS"], {"use_astar"}),
        (DwaSettings, ["DWAPlannerROS"], set()),
        (MppiSettings, ["MppiPlannerROS"], set()),
        (RotateSettings, ["TrajectoryPlannerROS"], set()),
        (CostmapSettings, ["global_costmap"], {"layers"}),
        (StaticSettings, ["global_costmap", "static_layer"], set()),
        (ObstacleSettings, ["global_costmap", "obstacle_layer"], {"sources"}),
        (SourceSettings, ["global_costmap", "obstacle_layer", "scan"], {"topic"}),
        (MoveSlowSettings, ["move_slow"], set()),
        (InflationSettings, ["global_costmap", "inflation_layer"], set()),
    ],
)
def test_each_default_is_listed_in_the_configuration_file(kind, keys, not_listed):
    tree = DOCUMENTED
    for key in keys:
        tree = tree[key]
    for item in fields(kind):
        if item.name not in not_listed:
            default = getattr(kind(), item.name)
            assert tree[item.name] == (list(default) if isinstance(default, tuple) else default), item.name


def layer_names(costmap):
    return [layer.name for layer in costmap.layers]


@pytest.mark.parametrize("name", ["move_base_lite.yaml", "turtlebot.yaml", "jackal.yaml"])
def test_a_shipped_file_is_read_without_a_warning(name):
    _, warnings = settings_from_parameters(yaml.safe_load((CONFIG / name).read_text()))
    assert warnings == []


def test_the_preset_configures_both_costmaps():
    settings = load_settings(CONFIG / "turtlebot.yaml")
    assert layer_names(settings.global_costmap) == ["static_layer", "obstacle_layer", "inflation_layer"]
    assert layer_names(settings.local_costmap) == ["obstacle_layer", "inflation_layer"]
    assert settings.local_costmap.rolling_window
    for costmap in (settings.global_costmap, settings.local_costmap):
        assert costmap.robot_radius == 0.2
        assert costmap.transform_tolerance == 0.5
        assert costmap.sources[0].inf_is_valid


def test_costmap_parameters_from_before_plugins_are_accepted():
    settings, _ = settings_from_parameters(
        {
            "global_costmap": {
                "static_map": True,
                "inflation_radius": 0.4,
                "observation_sources": "scan bump",
                "scan": {"data_type": "LaserScan", "topic": "/scan", "clearing": True},
                "bump": {"data_type": "PointCloud2"},
            }
        }
    )
    costmap = settings.global_costmap
    assert layer_names(costmap) == ["static_layer", "obstacle_layer", "inflation_layer"]
    assert costmap.layers[2].settings.inflation_radius == 0.4
    scan, bump = costmap.sources
    assert (scan.topic, scan.clearing, scan.data_type) == ("/scan", True, "LaserScan")
    assert (bump.topic, bump.clearing, bump.data_type) == ("bump", False, "PointCloud2")


def test_old_names_of_dwa_are_accepted_with_a_warning():
    settings, warnings = settings_from_parameters(
        {**DWA, "DWAPlannerROS": {"max_trans_vel": 0.3, "max_rot_vel": 5.0}}
    )
    assert (settings.controller.max_vel_trans, settings.controller.max_vel_theta) == (0.3, 5.0)
    assert "parameter DWAPlannerROS/max_trans_vel is deprecated, use max_vel_trans instead" in warnings


def test_the_latch_is_accepted_at_both_levels():
    for parameters in (
        {"latch_xy_goal_tolerance": True},
        {**DWA, "DWAPlannerROS": {"latch_xy_goal_tolerance": True}},
    ):
        assert settings_from_parameters(parameters)[0].controller.latch_xy_goal_tolerance


def test_a_footprint_can_be_text_and_is_inherited_by_the_costmaps():
    corners = "[[0.2, 0.1], [0.2, -0.1], [-0.2, 0.0]]"
    settings, _ = settings_from_parameters({"footprint": corners})
    assert settings.local_costmap.footprint == ((0.2, 0.1), (0.2, -0.1), (-0.2, 0.0))


@pytest.mark.parametrize(
    "parameters, text",
    [
        ({"controller_frequency": 0}, "/move_base/controller_frequency must be positive, got 0.0"),
        (
            {**DWA, "DWAPlannerROS": {"max_vel_x": "fast"}},
            "/move_base/DWAPlannerROS/max_vel_x must be a number",
        ),
        ({"footprint": "here"}, "/move_base/global_costmap/footprint must be a list of points"),
        (
            {"recovery_behaviors": [{"name": "jump", "type": "jump/Jump"}]},
            "recovery_behaviors: jump has an unknown type 'jump/Jump'",
        ),
        ({"footprint": 5000 * "["}, "/move_base/global_costmap/footprint must be a list of points"),
        ({"footprint": MERGED_OFTEN}, "/move_base/global_costmap/footprint must be a list of points"),
        (
            {"global_costmap": {"obstacle_layer": "many", "scan": {"topic": "scan"}}},
            "/move_base/global_costmap/obstacle_layer must be a table of parameters, got 'many'",
        ),
    ],
)
def test_an_invalid_value_is_refused_with_its_full_name(parameters, text):
    with pytest.raises(SettingsError) as caught:
        settings_from_parameters(parameters, "/move_base/")
    assert text in str(caught.value)


def test_an_unknown_name_causes_a_warning():
    parameters = {**DWA, "DWAPlannerROS": {"sim_tme": 1.0, "zebra": 2}, "planner_frequncy": 1.0}
    _, warnings = settings_from_parameters(parameters, "/move_base/")
    assert warnings == [
        'unknown parameter /move_base/planner_frequncy (did you mean "planner_frequency"?)',
        'unknown parameter /move_base/DWAPlannerROS/sim_tme (did you mean "sim_time"?)',
        "unknown parameter /move_base/DWAPlannerROS/zebra",
    ]


def test_trajectory_planner_has_parameters_and_defaults_different_from_dwa():
    own = {"max_rotational_vel": 0.8, "pdist_scale": 0.9, "dwa": False, "escape_vel": -0.1}
    settings, warnings = settings_from_parameters({"TrajectoryPlannerROS": own})
    controller = settings.controller
    assert (controller.max_vel_theta, controller.path_distance_bias, controller.use_dwa) == (0.8, 0.9, False)
    assert (controller.max_vel_x, controller.max_vel_trans, controller.min_vel_x) == (0.5, 0.5, 0.1)
    assert (controller.sim_time, controller.yaw_goal_tolerance) == (1.0, 0.05)
    assert warnings == []


def test_ranges_of_sources_are_inherited_from_enclosing_namespaces():
    layer = {
        "observation_sources": "front back",
        "raytrace_range": 6.0,
        "back": {"data_type": "LaserScan", "obstacle_range": 1.0},
    }
    plugins = [{"name": "obstacle_layer", "type": "costmap_2d::VoxelLayer"}]
    settings, warnings = settings_from_parameters(
        {"obstacle_range": 4.0, "local_costmap": {"plugins": plugins, "obstacle_layer": layer}}
    )
    front, back = settings.local_costmap.sources
    assert (front.topic, front.obstacle_range, front.raytrace_range) == ("front", 4.0, 6.0)
    assert (back.topic, back.obstacle_range, back.raytrace_range) == ("back", 1.0, 6.0)
    assert warnings == []


@pytest.mark.parametrize(
    "costmap, layer, tracks",
    [(True, {}, True), (False, {}, False), (None, {"track_unknown_space": True}, True)],
)
def test_a_layer_inherits_track_unknown_space_from_its_costmap(costmap, layer, tracks):
    plugins = [{"name": "obstacle_layer", "type": "costmap_2d::ObstacleLayer"}]
    parameters = {"plugins": plugins, "obstacle_layer": layer}
    if costmap is not None:
        parameters["track_unknown_space"] = costmap
    settings, warnings = settings_from_parameters({"global_costmap": parameters})
    assert settings.global_costmap.layers[0].settings.track_unknown_space is tracks
    assert warnings == []


def test_plans_avoid_unknown_cells_if_the_layer_tracks_them():
    parameters = yaml.safe_load((CONFIG / "turtlebot.yaml").read_text())
    parameters["global_costmap"]["obstacle_layer"]["track_unknown_space"] = True
    settings, _ = settings_from_parameters(parameters)
    grid = grid_from_picture("..........\n..........\n????......\n..........\n..........", 0.5)
    navigator = Navigator(settings, grid)
    start, goal = Pose2(0.75, 0.75), Pose2(0.75, 1.75)
    assert navigator.make_plan(start, goal)[:, 0].max() > 2.0


def test_move_slow_and_clear_is_read():
    listed = [{"name": "slow", "type": "move_slow_and_clear/MoveSlowAndClear"}]
    slow = {"limited_trans_speed": 0.1, "max_trans_param_name": "max_vel_trans"}
    settings, warnings = settings_from_parameters({"recovery_behaviors": listed, "slow": slow})
    assert settings.recoveries[0].settings == MoveSlowSettings(limited_trans_speed=0.1)
    assert warnings == []


@pytest.mark.parametrize("listed", [5, [{"name": ["a"], "type": "b"}], [{"name": "a"}], "rotate"])
def test_an_invalid_list_of_recovery_behaviours_is_replaced_by_the_default(listed):
    settings, warnings = settings_from_parameters({"recovery_behaviors": listed})
    assert settings.recoveries == settings_from_parameters({})[0].recoveries
    assert "recovery_behaviors must be a list of {name, type}" in warnings[0]


def test_an_unknown_layer_to_clear_causes_a_warning():
    listed = [{"name": "clear", "type": "clear_costmap_recovery/ClearCostmapRecovery"}]
    _, warnings = settings_from_parameters(
        {"recovery_behaviors": listed, "clear": {"layer_names": [["obstacle_layer"]]}}
    )
    assert "no costmap has a layer ['obstacle_layer']" in warnings[0]


def test_recovery_behaviours_have_the_configured_order():
    listed = [
        {"name": "rotate", "type": "rotate_recovery/RotateRecovery"},
        {"name": "clear", "type": "clear_costmap_recovery/ClearCostmapRecovery"},
    ]
    settings, _ = settings_from_parameters({"recovery_behaviors": listed, "clear": {"reset_distance": 1.5}})
    assert [recovery.name for recovery in settings.recoveries] == ["rotate", "clear"]
    assert settings.recoveries[1].settings.reset_distance == 1.5


def test_without_parameters_the_official_defaults_apply():
    settings, warnings = settings_from_parameters({})
    assert settings.move_base == NavigatorSettings().move_base
    assert isinstance(settings.controller, DwaSettings), "TrajectoryPlannerROS"
    assert [recovery.name for recovery in settings.recoveries][::2] == [
        "conservative_reset",
        "aggressive_reset",
    ]
    assert warnings == []


def test_merged_parameters_override_nested_values():
    below = {"a": {"b": 1, "c": 2}, "d": 1}
    assert merged(below, {"a": {"c": 3}, "d": {"e": 4}}) == {"a": {"b": 1, "c": 3}, "d": {"e": 4}}
    assert below == {"a": {"b": 1, "c": 2}, "d": 1}


@pytest.mark.parametrize("name", ["turtlebot3_burger", "turtlebot3_waffle", "turtlebot_kinect"])
def test_each_robot_file_has_valid_parameters_and_changes_the_preset(name):
    preset = load_settings(CONFIG / "turtlebot.yaml")
    assert load_settings(CONFIG / "turtlebot.yaml", CONFIG / f"{name}.yaml") != preset
    parameters = yaml.safe_load((CONFIG / f"{name}.yaml").read_text())
    assert (
        settings_from_parameters({**parameters, "base_local_planner": "move_base_lite/MppiPlannerROS"})[1]
        == []
    )


def test_a_value_of_a_wrong_type_can_be_ignored_with_a_warning():
    own = {"max_vel_x": "fast", "max_vel_theta": 0.7}
    parameters = {"base_local_planner": "dwa_local_planner/DWAPlannerROS", "DWAPlannerROS": own}
    settings, warnings = settings_from_parameters(parameters, "/move_base/", is_lenient=True)
    assert settings.controller.max_vel_theta == 0.7
    message = "/move_base/DWAPlannerROS/max_vel_x must be a number, got 'fast': it counts as not set"
    assert message in warnings
