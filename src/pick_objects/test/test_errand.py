from pathlib import Path

import pytest
import yaml

from pick_objects import Errand, ErrandSettings, ErrandState, Finish, GoalReached, GoalRefused, GoTo
from pick_objects.config import NodeSettings
from planar import Pose2, SettingsError
from planar.places import Place

PICKUP, DROPOFF = Place("pickup", Pose2(2.0, 3.0)), Place("dropoff", Pose2(-2.0, 1.0))


def errand(**settings):
    return Errand(PICKUP, DROPOFF, ErrandSettings(**settings))


def test_the_robot_is_sent_to_pickup_and_after_five_seconds_there_to_dropoff():
    task = errand()
    assert task.advance(0.0) == GoTo(PICKUP, 1)
    assert task.advance(10.0) is None
    assert task.advance(20.0, GoalReached()) is None
    assert task.state is ErrandState.PICKING_UP
    assert task.advance(24.9) is None
    assert task.advance(25.0) == GoTo(DROPOFF, 1)
    assert task.advance(40.0, GoalReached()) == Finish(True, "delivered at place dropoff")
    assert task.state is ErrandState.DELIVERED
    assert task.advance(41.0) is None


def test_a_refused_goal_is_tried_again_after_a_pause():
    task = errand(attempts=2, retry_seconds=1.0)
    task.advance(0.0)
    assert task.advance(5.0, GoalRefused("blocked")) is None
    assert task.advance(5.9) is None
    assert task.advance(6.0) == GoTo(PICKUP, 2)


def test_the_last_refusal_ends_the_errand_with_place_and_reason():
    task = errand(attempts=1)
    task.advance(0.0)
    order = task.advance(5.0, GoalRefused("Failed to find a valid plan."))
    assert order == Finish(False, "place pickup not reached after 1 attempt: Failed to find a valid plan.")
    assert task.state is ErrandState.FAILED


def test_a_goal_that_takes_too_long_counts_as_refused():
    task = errand(attempts=1, goal_timeout=30.0)
    task.advance(0.0)
    assert task.advance(30.0) is None
    assert "not reached within 30 s" in task.advance(30.1).reason


def test_attempts_are_counted_for_each_place_anew():
    task = errand(attempts=2, retry_seconds=0.0, pickup_seconds=0.0)
    task.advance(0.0)
    task.advance(1.0, GoalRefused("x"))
    assert task.advance(1.0) == GoTo(PICKUP, 2)
    task.advance(2.0, GoalReached())
    assert task.advance(2.0) == GoTo(DROPOFF, 1)


def test_senseless_patience_is_refused():
    with pytest.raises(SettingsError, match="attempts must be at least 1"):
        errand(attempts=0)


def test_the_shipped_configuration_is_the_default_one():
    shipped = yaml.safe_load((Path(__file__).parents[1] / "config/pick_objects.yaml").read_text())
    defaults = {**vars(ErrandSettings()), **vars(NodeSettings(zones_file="x"))}
    del defaults["zones_file"]
    assert shipped == defaults
