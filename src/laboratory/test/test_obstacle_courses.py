"""Worlds of static and moving cylinders, generated and from DynaBARN's files."""

from dataclasses import replace

import numpy as np
import pytest

from laboratory.generators.crossings import POLYNOMIALS, CrossingCylinders
from laboratory.generators.fields import CylinderFields
from laboratory.generators.motions import GROUP_SPACING, MOTIONS, RADIUS
from laboratory.runner import run_scenario
from laboratory.suites import load_suites
from laboratory.tasks.odom_goal import navigation_config
from laboratory.worlds.dynabarn import DynabarnFolder
from move_base_lite import load_settings
from planar import Pose2
from sim_bridge import robot_named
from sim_bridge.faults import Fault

WORLD = """\
start: [11.0, 0.0, 3.14159265]
goal: [-9.0, 0.0]
walls:
  - [-10.0, 0.0, 0.5, 20.0]
obstacles:
  - {name: slow, radius: 0.5, height: 1, period: 4.0, keyframes: [[0, 3, 1], [2, 3, -1], [4, 3, 1]]}
"""
SCENARIO = """\
world: {dynabarn: worlds}
robot: {profile: jackal, start: {x: 11.0, y: 0.0, yaw: 3.141592653589793}}
simulation: {odometry_rate: 100, scan_rate: 20}
task: {reach: {x: 4.0, y: 0.0}}
limits: {seconds: 20}
"""


def places(arena):
    return {body.name: body.pose_in_world[:2, 3].tolist() for body in arena.world.bodies}


@pytest.mark.parametrize("source", [CylinderFields(), CrossingCylinders()], ids=["fields", "crossings"])
def test_each_seed_has_a_different_world(source):
    uncached = type(source).arena.__globals__["_arena"].__wrapped__
    arguments = (1,) if isinstance(source, CylinderFields) else (source, 1)
    assert places(source.arena(1)) == places(uncached(*arguments)) != places(source.arena(2))


def test_every_field_has_a_path():
    lengths = [CylinderFields().arena(seed).reference_length for seed in range(8)]
    assert all(length is not None and 10.0 <= length < 14.0 for length in lengths), lengths
    assert len(set(lengths)) > 1


@pytest.mark.parametrize("legs", [1, 4])
def test_crossing_cylinders_move_back_and_forth_continuously(legs):
    for trajectory in CrossingCylinders(1.0, 1.0, legs=legs).arena(3).world.trajectories:
        places_xy = np.array([trajectory.at(stamp) for stamp in np.arange(0.0, 100.0, 0.1)])
        speeds = np.hypot(*np.diff(places_xy, axis=0).T) / 0.1
        assert np.median(speeds) > 0.85 and speeds.max() < 1.15


def test_crossing_cylinders_have_the_requested_number_and_legs():
    trajectories = CrossingCylinders(1.0, 1.0, min_count=20, max_count=22, legs=4).arena(3).world.trajectories
    assert 20 <= len(trajectories) <= 22
    assert {len(trajectory.times) for trajectory in trajectories} == {2 * 4 + 2}


@pytest.mark.parametrize("motion", MOTIONS)
def test_each_motion_stays_in_the_area_at_its_speed(motion):
    source = CrossingCylinders(1.0, 1.4, 9, 9, motion=motion)
    trajectories = source.arena(3).world.trajectories
    assert len(trajectories) == 9
    assert places(source.arena(3)) != places(source.arena(4))
    for trajectory in trajectories:
        assert np.abs(trajectory.points_xy).max() <= 10.0 + 2.0 * GROUP_SPACING
        lengths = np.linalg.norm(np.diff(trajectory.points_xy, axis=0), axis=1)
        speeds = lengths[lengths > 1e-6] / np.diff(trajectory.times)[lengths > 1e-6]
        assert speeds.min() > 0.99 and speeds.max() < 1.41


@pytest.mark.parametrize("motion", [motion for motion in MOTIONS if motion != POLYNOMIALS])
def test_only_polynomials_jump_back_to_their_first_point(motion):
    for trajectory in CrossingCylinders(1.0, 1.4, motion=motion).arena(3).world.trajectories:
        assert np.allclose(trajectory.points_xy[0], trajectory.points_xy[-1], atol=1e-6)


def test_polynomials_lead_from_border_to_border_as_dynabarns():
    # The 87 trajectories of the four hard worlds that we have: 11 keyframes, 60 m and at most 1.95 m/s.
    source = CrossingCylinders(1.5, 1.9, 60, 60, motion=POLYNOMIALS, orders=(4, 6))
    trajectories = source.arena(0).world.trajectories
    for trajectory in trajectories:
        assert np.abs(trajectory.points_xy[[0, -1]]).max(axis=1) == pytest.approx(10.0)
    lengths = [np.linalg.norm(np.diff(each.points_xy, axis=0), axis=1).sum() for each in trajectories]
    assert 50.0 < np.mean(lengths) < 75.0
    assert 10.0 < np.mean([len(each.times) for each in trajectories]) < 13.0


def test_what_comes_out_of_doors_does_not_pass_through_walls():
    world = CrossingCylinders(1.0, 1.0, motion="through_doors").arena(5).world
    walls = [body for body in world.bodies if body.name.startswith("door_wall")]
    assert len(walls) == 8
    for trajectory in world.trajectories:
        points_xy = np.array([trajectory.at(stamp) for stamp in np.arange(0.0, 60.0, 0.1)])
        for body in walls:
            half = 0.5 * np.array(body.collisions[0].shape.size[:2])
            beyond = np.maximum(np.abs(points_xy - body.pose_in_world[:2, 3]) - half, 0.0)
            assert np.hypot(*beyond.T).min() > RADIUS


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "worlds").mkdir()
    for number in (0, 10, 5):
        (tmp_path / f"worlds/dynabarn_{number}.yaml").write_text(WORLD)
    (tmp_path / "scenario.yaml").write_text(SCENARIO)
    return tmp_path


def test_dynabarn_worlds_are_used_in_turn_and_move(folder):
    source = DynabarnFolder(folder / "worlds")
    assert [source.arena(seed).title for seed in range(3)] == ["DynaBARN 0", "DynaBARN 5", "DynaBARN 10"]
    arena = source.arena(0)
    assert arena.reference_length == 20.0
    assert [trajectory.at(5.0) for trajectory in arena.world.trajectories] == [(3.0, 0.0)]


def test_a_dynabarn_scenario_runs(folder):
    (scenario,), complaints = load_suites([str(folder / "scenario.yaml")])
    assert complaints == []
    assert run_scenario(scenario, 0).outcome == "success"


@pytest.mark.parametrize(
    ("fault", "complaint"),
    [
        ("odometry_stopped", "waiting for a trustworthy sensor (odometry: none for 10."),
        ("odometry_frozen", "waiting for a trustworthy sensor (odometry: it stands still"),
        ("scan_nan", "waiting for a trustworthy sensor (scan: nearly all of its beams are NaN"),
    ],
)
def test_a_robot_does_not_drive_on_inputs_that_it_cannot_trust(folder, fault, complaint):
    (scenario,), _ = load_suites([str(folder / "scenario.yaml")])
    scenario = replace(
        scenario,
        seconds=40.0,
        task=replace(scenario.task, goal=Pose2(12.0, 0.0)),
        faults=(Fault(fault, start=1.0),),
    )
    trace = scenario.task.run(scenario, scenario.world.arena(0), 0)
    assert trace.outcome == "failure"
    assert complaint in trace.reason
    stands_at, before = trace.trajectory[-1, 1:3], trace.trajectory[-20, 1:3]
    assert np.allclose(stands_at, before, atol=1e-4)


@pytest.mark.parametrize(
    ("wrong", "complaint"),
    [
        ("motion: zigzag", "motion must be one of straight, polynomials, stop_and_go"),
        ("motion: circles, legs: 2", "legs must be absent: it belongs to the motion straight"),
        ("motion: circles, orders: [1, 2]", "orders must be absent: it belongs to the motion polynomials"),
        ("motion: polynomials, orders: [3, 2]", "orders must be two whole numbers from 1 to 9"),
    ],
)
def test_a_wrong_motion_is_reported(folder, wrong, complaint):
    text = SCENARIO.replace("{dynabarn: worlds}", f"{{crossings: {{speed: [0.5, 1.0], {wrong}}}}}")
    (folder / "scenario.yaml").write_text(text)
    _, complaints = load_suites([str(folder / "scenario.yaml")])
    assert len(complaints) == 1 and f"scenario.yaml:1: world.crossings.{complaint}" in complaints[0]


@pytest.mark.parametrize(
    ("wrong", "complaint"),
    [
        ("keyframes: [[0, 3, 1], [0, 3, -1]]", "slow::link: a trajectory needs increasing times"),
        ("keyframes: [[0, 3]]", "keyframes must be lists of 3 numbers"),
        ("keyframes: [[0, 3, x]]", "keyframes must be lists of 3 numbers"),
    ],
)
def test_an_invalid_world_is_reported(folder, wrong, complaint):
    (folder / "worlds/dynabarn_0.yaml").write_text(WORLD.replace(WORLD[WORLD.index("keyf") : -2], wrong))
    _, complaints = load_suites([str(folder / "scenario.yaml")])
    assert len(complaints) == 1 and complaint in complaints[0]


def test_one_set_of_parameters_serves_static_and_moving_obstacles():
    scenarios, _ = load_suites(["fields", "crossings"])
    assert [scenario.parameters for scenario in scenarios] == [{}, {}]
    control, drive = load_settings(navigation_config("jackal")).controller, robot_named("jackal").drive
    assert (control.max_vel_x, control.acc_lim_x) == (drive.max_speed, drive.max_acceleration)
    assert control.acc_lim_theta == drive.max_turn_acceleration
