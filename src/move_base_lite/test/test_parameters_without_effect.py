"""Parameters of move_base that are accepted without effect are named once, with the reason."""

from pathlib import Path

import pytest
import yaml

from move_base_lite.costmap.layers.voxels import NOT_PUBLISHED
from move_base_lite.parameters import read_parameters

CONFIG = Path(__file__).resolve().parents[1] / "config"
DWA = {"base_local_planner": "dwa_local_planner/DWAPlannerROS"}
LAYERS = [{"name": "obstacles", "type": "costmap_2d::ObstacleLayer"}]


def named(parameters):
    """What has no effect, by name and reason."""
    return list(read_parameters(parameters, "/move_base/").without_effect)


@pytest.mark.parametrize(
    "parameters, text",
    [
        (
            {**DWA, "DWAPlannerROS": {"scaling_speed": 0.5}},
            "DWAPlannerROS/scaling_speed has no effect: the footprint is exact",
        ),
        (
            {"NavfnROS": {"planner_window_x": 2.0}},
            "NavfnROS/planner_window_x has no effect: the official planner does not use it either",
        ),
        (
            {"local_costmap": {"map_type": "voxel", "publish_voxel_map": True}},
            f"local_costmap/obstacle_layer/publish_voxel_map has no effect: {NOT_PUBLISHED}",
        ),
        (
            {"local_costmap": {"plugins": LAYERS, "static_map": True}},
            "local_costmap/static_map has no effect: plugins lists the layers",
        ),
        (
            {"local_costmap": {"plugins": LAYERS, "inflation_layer": {"inflation_radius": 0.5}}},
            "local_costmap/inflation_layer has no effect: plugins lists no layer of this name",
        ),
        (
            {"local_costmap": {"plugins": LAYERS, "inflation_radius": 0.5}},
            "local_costmap/inflation_radius has no effect: plugins lists no costmap_2d::InflationLayer",
        ),
        (
            {"local_costmap": {"plugins": LAYERS, "obstacles": {"scan": {"topic": "scan"}}}},
            "local_costmap/obstacles/scan has no effect: observation_sources does not list it",
        ),
        (
            {"local_costmap": {"plugins": [*LAYERS, *LAYERS]}},
            "local_costmap/plugins: the second entry obstacles has no effect: names of layers must differ",
        ),
        (
            {"TebLocalPlannerROS": {"max_vel_x": 0.4}},
            "TebLocalPlannerROS has no effect: no plugin of this name is configured",
        ),
    ],
)
def test_a_parameter_without_effect_is_named_with_its_reason(parameters, text):
    assert named(parameters) == [f"/move_base/{text}"]


@pytest.mark.parametrize(
    "parameters",
    [
        {**DWA, "DWAPlannerROS": {"max_vel_y": 0.0, "min_vel_y": 0.0, "vy_samples": 1, "prune_plan": True}},
        {**DWA, "DWAPlannerROS": {"scaling_speed": 0.25, "stop_time_buffer": 0.2}},
        {**DWA, "TrajectoryPlannerROS": {"max_vel_x": 0.3}},
    ],
)
def test_what_is_done_anyway_or_applies_to_a_planner_to_choose_is_not_named(parameters):
    assert named(parameters) == []


@pytest.mark.parametrize("name", ["turtlebot.yaml", "jackal.yaml"])
def test_every_parameter_of_a_preset_has_an_effect(name):
    found = read_parameters(yaml.safe_load((CONFIG / name).read_text()))
    assert list(found.without_effect) == found.unknown == []


def test_unknown_parameters_are_counted_apart():
    found = read_parameters({"planner_frequncy": 1.0}, "/move_base/")
    assert len(found.unknown) == len(found.warnings) == 1
    assert len(found.without_effect) == 0
