"""Custom plugins: found by dotted names, checked against their contract, and unable to crash the node."""

import pytest
import yaml
from robot_in_picture import PRESET, Robot, drive_to_end, two_rooms

from move_base_lite import Navigator, Status, settings_from_parameters
from move_base_lite.check import CHECK_SUITES
from planar import Pose2, SettingsError
from planar.extensions.check import run_checks

GRID = two_rooms(door=0.9)


def parameters_with(**chosen):
    preset = yaml.safe_load(PRESET.read_text())
    return {**preset, "controller_patience": 1.0, "planner_patience": 1.0, **chosen}


def drive(grid=GRID, **chosen):
    settings, warnings = settings_from_parameters(parameters_with(**chosen))
    assert not warnings
    robot, navigator = Robot(grid, Pose2(0.6, 0.6)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.4, 3.4, 1.0))
    return robot, drive_to_end(robot, navigator)


@pytest.mark.parametrize("name", ["pure_pursuit/PurePursuit", "potential_field/PotentialField"])
def test_a_local_planner_is_selected_by_its_dotted_name_and_gets_its_parameters(name):
    namespace = {name.partition("/")[2]: {"lookahead": 0.3, "latch_xy_goal_tolerance": True}}
    robot, decisions = drive(base_local_planner=f"plugin_examples.{name}", **namespace)
    assert decisions[-1].text == "Goal reached."
    assert robot.clearance > 0.0


def test_a_global_planner_is_selected_by_its_dotted_name():
    _, decisions = drive(base_global_planner="plugin_examples.rrt_star/RrtStar", RrtStar={"seed": 4})
    assert decisions[-1].text == "Goal reached."


@pytest.mark.parametrize(
    "name, reason",
    [
        ("no_such.module/Planner", "no module no_such on Python's path"),
        ("planar.errors/Planner", "no Planner in "),
        ("planar.errors/PlanarError", "is no local planner: it has no follow(context, plan, limits)"),
        ("custom_plugins.faulty/NoFollow", "it has no follow(context, plan, limits)"),
        ("custom_plugins.faulty/TooFewArguments", "it cannot be called as follow(context, plan, limits)"),
        (
            "custom_plugins.faulty/WrongSettings",
            "its Settings is not a dataclass derived from ControllerSettings",
        ),
        ("custom_plugins.broken/Planner", "importing custom_plugins.broken raised RuntimeError: no GPU"),
    ],
)
def test_an_invalid_class_is_refused_with_what_it_lacks(name, reason):
    with pytest.raises(SettingsError) as refused:
        settings_from_parameters(parameters_with(base_local_planner=name), "/move_base/")
    assert str(refused.value).startswith(f"/move_base/base_local_planner: {name}")
    assert reason in str(refused.value)


@pytest.mark.parametrize(
    "name, fault",
    [
        ("Raises", "raised ZeroDivisionError: division by zero"),
        ("RaisesInConstructor", "raised OSError: no weights.npz"),
        ("ReturnsNan", "asked for nan m/s"),
        ("ReturnsNothing", "raised AttributeError"),
        ("ExceedsLimits", "asked for 100 m/s, 0 rad/s, beyond its limits"),
        ("ModifiesCosts", "raised ValueError: assignment destination is read-only"),
        ("TakesTooLong", "took 1.2 s for an answer"),
    ],
)
def test_a_faulty_local_planner_is_named_and_the_goal_aborted_at_a_standstill(name, fault):
    robot, decisions = drive(
        base_local_planner=f"custom_plugins.faulty/{name}", recovery_behavior_enabled=False
    )
    assert decisions[-1].status is Status.ABORTED
    assert f"[code=PLUGIN_FAILED: custom_plugins.faulty/{name} {fault}" in decisions[-1].text
    assert robot.pose == Pose2(0.6, 0.6)


def test_costs_that_a_local_planner_tries_to_modify_stay():
    settings, _ = settings_from_parameters(
        parameters_with(base_local_planner="custom_plugins.faulty/ModifiesCosts")
    )
    robot, navigator = Robot(GRID, Pose2(0.6, 0.6)), Navigator(settings, GRID)
    navigator.set_goal(Pose2(5.4, 3.4, 1.0))
    for _ in range(5):
        robot.tick(navigator)
    assert (navigator.local_costmap.costs > 0).any()


def test_a_faulty_global_planner_is_named():
    _, decisions = drive(base_global_planner="custom_plugins.faulty/BadPlan", recovery_behavior_enabled=False)
    assert (
        "[code=PLUGIN_FAILED: custom_plugins.faulty/BadPlan gave a path that is not finite]"
        in decisions[-1].text
    )


def test_a_faulty_recovery_behaviour_is_skipped():
    behaviors = [{"name": "mine", "type": "custom_plugins.faulty/BadRecovery"}]
    _, decisions = drive(two_rooms(door=0.0), recovery_behaviors=behaviors)
    assert any(
        decision.text.startswith("custom_plugins.faulty/BadRecovery raised KeyError")
        for decision in decisions
    )
    assert decisions[-1].status is Status.ABORTED


def test_a_failing_layer_aborts_the_goal_and_stops_the_robot():
    parameters = parameters_with()
    parameters["local_costmap"]["plugins"].append({"name": "mine", "type": "custom_plugins.faulty/BadLayer"})
    settings, _ = settings_from_parameters(parameters)
    robot, navigator = Robot(GRID, Pose2(0.6, 0.6)), Navigator(settings, GRID)
    navigator.set_goal(Pose2(5.4, 3.4, 1.0))
    decisions = drive_to_end(robot, navigator)
    assert decisions[-1].status is Status.ABORTED
    assert (
        "custom_plugins.faulty/BadLayer raised IndexError: index 400 is out of bounds" in decisions[-1].text
    )
    assert robot.tick(navigator).text.startswith("custom_plugins.faulty/BadLayer raised IndexError")


def test_the_check_reports_what_a_plugin_fails(capsys):
    assert run_checks("move_base_lite", CHECK_SUITES, ["custom_plugins.faulty/ExceedsLimits"]) == 1
    printed = capsys.readouterr().out
    assert "FAIL  It reaches the goal and stops there without a collision" in printed
    assert "custom_plugins.faulty/ExceedsLimits: 0 of 6 checks passed" in printed


def test_the_check_refuses_a_class_that_is_no_plugin(capsys):
    assert run_checks("move_base_lite", CHECK_SUITES, ["custom_plugins.faulty/NoFollow"]) == 2
    assert "is no local planner: it has no follow(context, plan, limits)" in capsys.readouterr().err
