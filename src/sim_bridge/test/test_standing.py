"""A robot that stands: its body stays where it is, and its odometry does not integrate the gyro's bias."""

import numpy as np
import pytest

from planar import Pose2, Twist2, wrap
from sim_bridge import ROBOTS, Simulation, SimulationSettings
from sim_bridge.driving.drive import REST_SECONDS
from sim_bridge.geometry.pose3 import from_pose2, pose3
from sim_bridge.geometry.shapes import Plane
from sim_bridge.noise import noise_named
from sim_bridge.physics.forces import LinkWrench
from sim_bridge.physics.kinematics import at_rest
from sim_bridge.sensors.odometry import DeadReckoning, TrueMotion
from sim_bridge.simulation import ROBOT_NAME
from sim_bridge.world import Body, Collision, World

FLOOR = World("floor", (Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),)),))
HIGH = SimulationSettings(**noise_named("high"))
TURTLEBOT = ROBOTS["turtlebot_lidar"]


def standing(robot=TURTLEBOT, settings=SimulationSettings()):
    """A simulation in which a robot has driven an arc and then stood for a while."""
    simulation = Simulation(FLOOR, robot, settings, seed=3)
    run(simulation, 3.0, Twist2(0.2, 0.5))
    run(simulation, REST_SECONDS + 2.0, Twist2())
    return simulation


def run(simulation, seconds, command=None):
    for _ in range(round(seconds / simulation.step_seconds)):
        result = simulation.step(command)
    return result


def turned(before, after):
    return abs(wrap(after.yaw - before.yaw))


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=list(ROBOTS))
def test_a_standing_robot_and_its_odometry_do_not_move(robot):
    simulation = standing(robot, HIGH)
    before, after = run(simulation, 0.1), run(simulation, 60.0)
    # Within a day, 1440 times as long, that is 1.5 mm and 0.08 degrees.
    for start, end in (
        (before.base_in_world, after.base_in_world),
        (before.odometry.base_in_odom, after.odometry.base_in_odom),
    ):
        assert start.distance_to(end) < 1e-6
        assert turned(start, end) < 1e-6
    assert np.allclose(before.wheel_angles, after.wheel_angles, atol=1e-6)
    assert (after.odometry.twist.v, after.odometry.twist.omega) == (0.0, 0.0)


def test_a_standing_robot_drives_off_as_soon_as_it_is_commanded():
    simulation = standing()
    before = run(simulation, 5.0)
    after = run(simulation, 2.0, Twist2(0.3, 0.0))
    driven = after.base_in_world.distance_to(before.base_in_world)
    # It accelerates at 2 m/s^2 at least.
    assert 0.3 * 2.0 - 0.3**2 / 4.0 <= driven <= 0.3 * 2.0
    odometry = after.odometry.base_in_odom.distance_to(before.odometry.base_in_odom)
    assert odometry == pytest.approx(driven, rel=0.1)


def test_a_standing_robot_can_be_pushed():
    simulation = standing()
    start = simulation.step()
    force, end = np.array([60.0, 0.0, 0.0]), start.stamp + 0.5
    wrench = LinkWrench(simulation.base, force, np.zeros(3), start.stamp, end)
    simulation.scene.forces.apply_link_wrench(wrench)
    assert run(simulation, 1.0).base_in_world.distance_to(start.base_in_world) > 0.05


def test_a_standing_robot_that_is_moved_stays_where_it_was_put():
    simulation = standing()
    run(simulation, 1.0)
    height = float(simulation.scene.models.state(ROBOT_NAME).pose[2, 3])
    for goal in (Pose2(2.0, 1.0, 0.5), Pose2(2.01, 1.0, 0.5)):
        simulation.scene.set_model_state(ROBOT_NAME, at_rest(from_pose2(goal, z=height)))
        after = run(simulation, 10.0).base_in_world
        assert after.distance_to(goal) < 1e-3
        assert turned(after, goal) < 1e-3


def test_a_standing_robot_that_is_lifted_falls():
    simulation = standing()
    run(simulation, 1.0)
    simulation.scene.set_model_state(ROBOT_NAME, at_rest(pose3(0.0, 0.0, 0.5)))
    run(simulation, 2.0)
    assert simulation.scene.models.state(ROBOT_NAME).pose[2, 3] < 0.1


def test_the_gyro_is_followed_again_when_a_standing_robot_is_turned_by_hand():
    model = DeadReckoning(TURTLEBOT.drive, True, HIGH, np.random.default_rng(1))
    motion = TrueMotion(Pose2(), Twist2(), (0.0, 0.0), 0.02)
    for _ in range(round(2.0 * REST_SECONDS / motion.seconds)):
        before = model.update(motion)
    for _ in range(100):  # wheels that stand while the base turns at 0.5 rad/s
        after = model.update(TrueMotion(Pose2(), Twist2(0.0, 0.5), (0.0, 0.0), 0.02))
    assert turned(before.base_in_odom, after.base_in_odom) == pytest.approx(1.0, abs=0.1)


def test_a_rewound_robot_does_not_remember_that_it_stood():
    simulation = Simulation(FLOOR, TURTLEBOT, seed=3)
    run(simulation, 1.0)
    simulation.mark()
    ends = []
    for seconds in (0.0, REST_SECONDS + 5.0):
        if seconds:
            run(simulation, seconds)
        simulation.rewind(seed=4)
        ends.append(repr(run(simulation, REST_SECONDS + 5.0)))
    assert ends[0] == ends[1]


def test_a_moving_base_is_not_held_however_slowly_it_is_commanded():
    simulation = standing()
    before = run(simulation, 0.1).base_in_world
    after = run(simulation, 20.0, Twist2(0.002, 0.0)).base_in_world
    assert before.distance_to(after) == pytest.approx(0.04, rel=0.1)
