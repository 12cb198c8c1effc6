import math
from dataclasses import replace

import numpy as np
import pytest

from laboratory.results.result import clearance
from laboratory.runner import run_scenario
from laboratory.scenario import read_scenario
from laboratory.suites import FOLDER
from laboratory.tasks.odom_goal import OdomGoalTask
from laboratory.tasks.shortest_paths import ShortestPaths
from laboratory.worlds.boxes import BOX_SPACING, MOVE_DISTANCE, SIZE
from laboratory.worlds.files import WorldFile
from planar import Pose2, grid_from_picture
from sim_bridge import SimulationSettings
from sim_bridge.faults import Fault

ERRAND = FOLDER / "home_errand.yaml"


def test_a_run_is_repeatable_and_measured():
    scenario = read_scenario(ERRAND)
    first, again = run_scenario(scenario, 3), run_scenario(scenario, 3)
    assert replace(first, wall_seconds=0.0) == replace(again, wall_seconds=0.0)
    assert first.is_success, first.reason
    assert first.way is not None and first.driven is not None
    # The zones are reached within centimetres, so no path is much shorter than the shortest one.
    assert 0.9 * first.way < first.driven < 1.6 * first.way
    assert first.clearance is not None and 0.15 < first.clearance < 1.0
    assert first.localization_mean is not None and first.localization_mean < 0.1


def test_a_run_that_cannot_be_executed_is_an_error():
    crowded = replace(read_scenario(ERRAND), boxes=500)
    result = run_scenario(crowded, 0)
    assert result.outcome == "error" and "there is space for" in result.reason


def test_a_run_that_takes_too_long_is_a_timeout():
    result = run_scenario(replace(read_scenario(ERRAND), seconds=2.0), 1)
    assert result.outcome == "timeout" and "not done within 2" in result.reason


def test_a_goal_is_reached_without_a_map():
    home = read_scenario(ERRAND)
    source = WorldFile(home.world.files()[0])
    rates = SimulationSettings(odometry_rate=100, scan_rate=20)
    task = OdomGoalTask(Pose2(1.0, 0.0), 0.3)
    ahead = replace(home, world=source, robot="jackal", simulation=rates, task=task)
    result = run_scenario(ahead, 5)
    assert result.is_success, result.reason
    assert result.localization_mean is None and result.way is None


def test_faults_also_apply_without_a_map():
    home = read_scenario(ERRAND)
    source = WorldFile(home.world.files()[0])
    rates = SimulationSettings(odometry_rate=100, scan_rate=20)
    task = OdomGoalTask(Pose2(1.0, 0.0), 0.1)
    carried = Fault("kidnapped", 0.5, strength=0.4)
    ahead = replace(
        home, world=source, robot="jackal", simulation=rates, task=task, faults=(carried,), seconds=3.0
    )
    run = ahead.task.run(ahead, ahead.arena(5), 5)
    assert np.hypot(*np.diff(run.trajectory[:, 1:3], axis=0).T).max() > 0.3


def test_boxes_are_moved_near_to_where_they_stood():
    arena = replace(read_scenario(ERRAND), boxes=2, moves=9, seconds=100.0).arena(3)
    boxes = {body.model: body.pose_in_world[:2, 3] for body in arena.world.bodies if "box_" in body.name}
    moves = arena.world.moves
    assert [move.stamp for move in moves] == sorted(move.stamp for move in moves)
    assert len(moves) == 9 and {move.model for move in moves} == set(boxes)
    for move in moves:
        assert 0.0 <= move.stamp <= 100.0
        assert np.abs(boxes[move.model] - (move.pose.x, move.pose.y)).max() <= MOVE_DISTANCE


def test_boxes_keep_their_distance_and_leave_goals_free():
    scenario = replace(read_scenario(ERRAND), boxes=10)
    arena = scenario.arena(4)
    places = [(pose.x, pose.y) for pose in scenario.task.required_poses(arena)]
    boxes = [body.pose_in_world[:2, 3] for body in arena.world.bodies if body.name.startswith("box_")]
    assert len(boxes) == 10
    for number, box in enumerate(boxes):
        assert all(math.dist(box, other) > BOX_SPACING for other in boxes[:number])
        assert all(math.dist(box, place) > SIZE[0] for place in places)
    again = [body.pose_in_world for body in scenario.arena(4).world.bodies]
    np.testing.assert_array_equal(again, [body.pose_in_world for body in arena.world.bodies])


def test_the_shortest_path_goes_round_a_wall():
    room = grid_from_picture("\n".join(["." * 41] * 20 + ["#" * 31 + "." * 10] + ["." * 41] * 20), 0.1)
    paths = ShortestPaths(room, 0.2)
    below, above = Pose2(0.55, 0.55), Pose2(0.55, 3.55)
    corner = math.hypot(3.35 - 0.55, 2.05 - 0.55)
    assert paths.length((below, above)) == pytest.approx(2 * corner, rel=0.05)
    assert paths.length((below, Pose2(2.55, 0.55))) == pytest.approx(2.0, abs=0.02)


def test_there_is_no_path_through_a_closed_wall():
    room = grid_from_picture("\n".join(["." * 20] * 10 + ["#" * 20] + ["." * 20] * 10), 0.1)
    assert ShortestPaths(room, 0.1).length((Pose2(0.5, 0.5), Pose2(0.5, 1.6))) is None


def test_clearance_is_the_distance_to_the_nearest_wall():
    world = read_scenario(ERRAND).arena(0).world
    track = np.array([[0.0, 0.0, 0.0, 0.0], [1.0, 0.1, 0.0, 0.0]])
    farther, nearer = clearance(world, track[:1]), clearance(world, track)
    assert farther is not None and nearer is not None and nearer <= farther
