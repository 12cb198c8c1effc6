"""Bodies on scripted trajectories are scanned at their positions, collide, and restart after a rewind."""

import numpy as np
import pytest

from planar import Pose2
from sim_bridge import Simulation, SimulationSettings, WorldError
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Cylinder, Plane
from sim_bridge.scripted_trajectories import ModelMove, ScheduledMoves, ScriptedTrajectory
from sim_bridge.world import Body, Collision, World

TIMES, POINTS = np.array([0.0, 2.0, 4.0]), np.array([(3.0, 0.0), (1.0, 0.0), (3.0, 0.0)])
EXACT = SimulationSettings(range_noise=0.0, wheel_slip=0.0)


def world(points_xy=POINTS):
    floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
    post = (Collision(Cylinder(0.2, 1.0), np.eye(4)),)
    walker = Body("walker::link", pose3(3.0, 0.0, 0.5), post, is_kinematic=True)
    return World("w", (floor, walker), trajectories=(ScriptedTrajectory("walker::link", TIMES, points_xy),))


def straight_ahead(observation):
    ranges = observation.scan.ranges
    return float(ranges[len(ranges) // 2])


def run(simulation, seconds):
    return [simulation.step() for _ in range(round(seconds / simulation.step_seconds))]


def test_a_scan_measures_the_body_at_its_position_on_the_trajectory():
    seen = [one for one in run(Simulation(world(), settings=EXACT), 7.9) if one.scan is not None]
    positions = [float(np.interp(one.stamp % 4.0, TIMES, POINTS[:, 0])) for one in seen]
    gaps = [x - straight_ahead(one) for x, one in zip(positions, seen)]
    assert np.ptp(positions) > 1.9
    assert np.ptp(gaps) < 0.041, "one update of the trajectory either way"


def test_a_body_does_not_stop_for_a_robot_and_the_contact_is_reported():
    simulation = Simulation(world(POINTS - (1.0, 0.0)), settings=EXACT)
    seen = run(simulation, 2.0)
    assert any("walker::link" in one.contacts for one in seen)
    assert seen[-1].base_in_world.x < -0.05, "the robot is pushed away"
    assert simulation.scene.models.state("walker").pose[0, 3] == pytest.approx(0.0, abs=0.05)


def test_a_body_repeats_its_trajectory_after_a_rewind():
    simulation = Simulation(world(), settings=EXACT)
    simulation.mark()
    scans = []
    for seconds in (1.3, 1.0, 1.0):
        simulation.rewind(7, Pose2(0.0, 0.1))
        scans.append([one.scan.ranges.tobytes() for one in run(simulation, seconds) if one.scan is not None])
    assert scans[0][: len(scans[1])] == scans[1] == scans[2]


def test_the_simulation_continues_after_a_body_was_removed():
    simulation = Simulation(world(), settings=EXACT)
    simulation.scene.remove_model("walker")
    assert simulation.step().stamp == simulation.step_seconds


def test_times_that_do_not_increase_are_an_error():
    with pytest.raises(WorldError, match="walker::link: a trajectory needs increasing times"):
        ScriptedTrajectory("walker::link", np.array([0.0, 2.0, 2.0]), POINTS)


def test_a_model_is_not_moved_to_where_a_robot_is():
    moved, far, near = [], np.array([[5.0, 0.0]]), np.array([[0.5, 0.0]])
    schedule = ScheduledMoves([ModelMove(2.0, "b", Pose2()), ModelMove(1.0, "a", Pose2())])
    assert (schedule.next_after(0.0), schedule.next_after(2.0)) == (1.0, np.inf)
    for stamp, robots in ((0.5, far), (1.5, near), (1.6, far), (3.0, far), (4.0, far)):
        schedule.update(stamp, robots, lambda name, pose, at=stamp: moved.append((at, name)))
    assert moved == [(1.6, "a"), (3.0, "b")]
    assert not schedule.is_due(0.0) and schedule.is_due(1.0), "after a rewind all are still to come"
