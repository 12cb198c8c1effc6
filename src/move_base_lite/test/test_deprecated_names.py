"""Custom planners that use the names of version 1.0 keep working, with a warning."""

import sys
import types
from dataclasses import dataclass, replace

import numpy as np
import pytest

import move_base_lite
from move_base_lite import (
    ControlContext,
    ControlError,
    ControllerSettings,
    Trajectory,
    settings_from_parameters,
)
from move_base_lite.check import CHECK_SUITES, maps
from move_base_lite.control import Plan
from move_base_lite.dynamic_obstacles import NO_DYNAMIC_OBSTACLES, DynamicObstacleTracker, TrackerSettings
from planar import Pose2, Twist2


def test_the_old_name_of_the_planner_input_is_an_alias():
    with pytest.warns(DeprecationWarning, match="use move_base_lite.ControlContext"):
        assert move_base_lite.Situation is ControlContext


def test_old_imports_of_people_resolve_to_the_obstacle_tracker():
    with pytest.warns(DeprecationWarning, match="use move_base_lite.dynamic_obstacles"):
        from move_base_lite.people import NO_MOVERS, Lookout, Movers
    assert (NO_MOVERS is NO_DYNAMIC_OBSTACLES, Lookout, Movers) == (
        True,
        TrackerSettings,
        DynamicObstacleTracker,
    )
    with pytest.warns(DeprecationWarning, match="use obstacles_at"):
        assert len(Movers().at(0.0)) == 0


def test_a_planner_may_read_and_replace_the_old_fields_of_its_input():
    context = maps.context_of(maps.check_map("open").costmap, Pose2())
    obstacles = np.array([[2.0, 1.0, 0.0, 0.3, 0.2]])
    with pytest.warns(DeprecationWarning):
        changed = replace(context, movers=obstacles)
    with pytest.warns(DeprecationWarning):
        assert changed.movers is changed.dynamic_obstacles is obstacles
    with pytest.warns(DeprecationWarning):
        assert context.whole is context.global_costmap


def test_a_planner_may_return_and_raise_its_samples_by_the_old_name():
    samples = object()
    with pytest.warns(DeprecationWarning):
        trajectory = Trajectory(Twist2(), np.zeros((1, 3)), 0.0, exploration=samples)
    assert trajectory.trajectory_samples is samples
    with pytest.warns(DeprecationWarning):
        assert ControlError("blocked", exploration=samples).trajectory_samples is samples


@dataclass(frozen=True)
class SettingsWithLookout(ControllerSettings):
    @property
    def lookout(self):
        return TrackerSettings(2.5)


def test_settings_may_ask_for_tracking_by_the_old_name():
    assert SettingsWithLookout().tracker_settings == TrackerSettings(2.5)
    assert ControllerSettings().tracker_settings is None


class OldPlanner:
    """Written for version 1.0: arguments are named as they were then."""

    def __init__(self, settings, period):
        self._settings, self._period = settings, period

    def follow(self, situation, plan, limits):
        assert len(situation.movers) == 0 and situation.whole is not None
        command = self._settings.reachable(situation.twist, Twist2(0.1, 0.0), limits, self._period)
        return Trajectory(command, situation.base_in_local.as_array()[None, :], 0.0)


def test_a_planner_with_the_old_argument_names_keeps_the_contract(monkeypatch):
    module = types.ModuleType("old.planners")
    module.OldPlanner = OldPlanner
    monkeypatch.setitem(sys.modules, "old.planners", module)
    plugin = CHECK_SUITES["local_planner"].find("old.planners/OldPlanner")
    context = maps.context_of(maps.check_map("open").costmap, Pose2())
    with pytest.warns(DeprecationWarning):
        trajectory = plugin.make(plugin.settings(), 0.1).follow(
            context, Plan(np.zeros((1, 2)), 1.0), Twist2(0.5, 1.0)
        )
    assert trajectory.command == Twist2(0.1, 0.0)


class OldGlobalPlanner:
    """Written for version 1.0, when a global planner got five arguments."""

    potential = None

    def __init__(self, settings):
        pass

    def plan(self, costs, window, start_xy, goal_xy, tolerance=0.0):
        assert costs.shape == (window.rows, window.cols) and tolerance == 0.5
        return np.array([start_xy, goal_xy])


def test_a_global_planner_with_five_arguments_is_given_a_request(monkeypatch):
    module = types.ModuleType("old.planners")
    module.OldGlobalPlanner = OldGlobalPlanner
    monkeypatch.setitem(sys.modules, "old.planners", module)
    with pytest.warns(DeprecationWarning, match=r"OldGlobalPlanner.plan\(costs, window, ...\) is deprecated"):
        plugin = CHECK_SUITES["global_planner"].find("old.planners/OldGlobalPlanner")
    request = replace(maps.check_map("open").plan_request, tolerance=0.5)
    path_xy = plugin.make(plugin.settings()).plan(request)
    assert path_xy.tolist() == [list(request.start_xy), list(request.goal_xy)]


def test_old_parameters_are_accepted_with_one_warning_each():
    old = {"mover_range": 9.0, "watch_what_appears": True, "heed_global_costmap": True, "mover_distance": 1.0}
    parameters = {"base_local_planner": "move_base_lite/MppiPlannerROS", "MppiPlannerROS": old}
    settings, warnings = settings_from_parameters(parameters)
    assert settings.controller.tracker_settings == TrackerSettings(9.0, track_appearing=True)
    assert (settings.controller.use_global_costmap, settings.controller.dynamic_obstacle_distance) == (
        True,
        1.0,
    )
    assert (
        "parameter MppiPlannerROS/mover_range is deprecated, use dynamic_obstacle_range instead" in warnings
    )
    assert len(warnings) == len(old)
