"""A robot in a world: it rests, drives and measures, and a seed repeats a run."""

import hashlib
import math
from pathlib import Path

import numpy as np
import pytest

from planar import Pose2, Twist2, wrap
from sim_bridge import ROBOTS, Simulation, SimulationSettings, WorldError, load_world
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Box, Cylinder, Plane
from sim_bridge.physics.kinematics import at_rest
from sim_bridge.sensors.kobuki import CENTRE, KobukiReading
from sim_bridge.simulation import ROBOT_NAME
from sim_bridge.views.section import CrossSection, cast_beams
from sim_bridge.world import Body, Collision, World

HOME = Path(__file__).resolve().parents[3] / "map" / "home.world"
EXACT = SimulationSettings(
    range_noise=0.0, encoder_scale=0.0, wheel_slip=0.0, gyro_scale=0.0, gyro_bias=0.0, gyro_noise=0.0
)


def body(name, shape, pose, mass=None):
    return Body(name, pose, (Collision(shape, np.eye(4)),), mass)


FLOOR = World("floor", (body("floor::link", Plane(), np.eye(4)),))
WALL = body("wall::link", Box((0.2, 4.0, 1.0)), pose3(1.0, 0.0, 0.5))
WALLED = World("walled", (*FLOOR.bodies, WALL))


def drive(simulation, command, seconds):
    """Give the command at every step; return the last result."""
    for _ in range(round(seconds / simulation.step_seconds)):
        observation = simulation.step(command)
    return observation


def digest(observations):
    content = hashlib.sha256()
    for seen in observations:
        content.update(repr((seen.stamp, seen.base_in_world, seen.odometry)).encode())
        if seen.scan is not None:
            content.update(seen.scan.ranges.tobytes())
    return content.hexdigest()


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=list(ROBOTS))
def test_the_robot_rests_without_jitter_and_does_not_sink(robot):
    simulation = Simulation(FLOOR, robot)
    drive(simulation, None, 1.0)
    for _ in range(100):
        observation = simulation.step()
        assert abs(observation.twist.v) < 1e-3
        assert abs(observation.twist.omega) < 1e-3
    assert observation.base_in_world.distance_to(Pose2()) < 1e-3


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=list(ROBOTS))
@pytest.mark.parametrize("command", [Twist2(0.2, 0.0), Twist2(0.2, 0.5), Twist2(-0.2, 0.3), Twist2(0.0, 1.0)])
def test_a_commanded_arc_is_driven_within_two_per_cent(robot, command):
    simulation = Simulation(FLOOR, robot, EXACT)
    before = drive(simulation, command, 2.0).base_in_world
    after = drive(simulation, command, 5.0).base_in_world
    if command.omega:
        turned = command.omega * 5.0
        assert abs(wrap(after.yaw - before.yaw - turned)) < 0.02 * abs(turned)
        chord = 2.0 * abs(command.v / command.omega * math.sin(command.omega * 5.0 / 2.0))
    else:
        chord = abs(command.v) * 5.0
    assert before.distance_to(after) == pytest.approx(chord, abs=0.02 * abs(command.v) * 5.0 + 1e-3)


def test_the_robot_does_not_tip_when_it_brakes_hard():
    simulation = Simulation(FLOOR, ROBOTS["turtlebot_kinect"])
    drive(simulation, Twist2(0.7, 0.0), 2.0)
    for _ in range(100):
        assert simulation.step(Twist2(-0.7, 0.0)).tilt < math.radians(2.0)


def test_speed_and_acceleration_are_limited():
    simulation = Simulation(FLOOR)
    limits = ROBOTS["turtlebot_lidar"].drive
    speeds = [simulation.step(Twist2(9.0, 0.0)).twist.v for _ in range(100)]
    assert max(speeds) == pytest.approx(limits.max_speed, rel=0.03), "it rocks a little"
    steepest = np.diff([0.0, *speeds]).max() / simulation.step_seconds
    assert steepest < 1.3 * limits.max_acceleration


def test_the_robot_stops_when_commands_cease():
    simulation = Simulation(FLOOR)
    assert drive(simulation, Twist2(0.3, 0.0), 1.0).twist.v == pytest.approx(0.3, rel=0.02)
    assert drive(simulation, None, 0.58).twist.v == pytest.approx(0.3, rel=0.02)
    assert abs(drive(simulation, None, 0.5).twist.v) < 1e-3


@pytest.mark.parametrize("command", [Twist2(math.nan, 0.0), Twist2(0.3, math.inf)])
def test_a_command_that_is_not_finite_stops_the_robot(command):
    simulation = Simulation(FLOOR)
    drive(simulation, Twist2(0.3, 0.0), 1.0)
    assert abs(drive(simulation, command, 0.5).twist.v) < 1e-3


def test_a_collision_with_a_wall_is_reported_and_the_wall_is_not_climbed():
    simulation = Simulation(WALLED, settings=EXACT)
    touched = set()
    for _ in range(200):
        observation = simulation.step(Twist2(0.7, 0.0))
        touched.update(observation.contacts)
        assert observation.tilt < math.radians(2.0)
    assert touched == {"wall::link"}
    assert observation.base_in_world.x == pytest.approx(0.9 - 0.178, abs=0.01)


def test_there_are_no_contacts_on_a_free_floor():
    simulation = Simulation(FLOOR)
    assert all(simulation.step(Twist2(0.5, 1.0)).contacts == () for _ in range(100))


def test_a_robot_that_is_moved_beside_an_obstacle_reports_the_contact_at_once():
    post = body("post::link", Cylinder(0.1, 1.0), pose3(3.0, 0.0, 0.5))
    simulation = Simulation(World("post", (*FLOOR.bodies, post)))
    models = simulation.scene.models
    assert simulation.step().contacts == ()
    models.set_link_state(simulation.base, models.state(ROBOT_NAME).at(pose3(2.8, 0.0, 0.0)))
    assert simulation.step().contacts == ("post::link",)
    models.set_link_state(simulation.base, models.state(ROBOT_NAME).at(pose3()))
    assert simulation.step().contacts == ()
    models.set_link_state("post::link", at_rest(pose3(0.2, 0.0, 0.5)))
    assert simulation.step().contacts == ("post::link",)


def test_odometry_without_errors_equals_the_true_pose():
    observation = drive(Simulation(FLOOR, settings=EXACT), Twist2(0.3, 0.4), 10.0)
    assert observation.odometry.base_in_odom.distance_to(observation.base_in_world) < 0.03
    assert abs(wrap(observation.odometry.base_in_odom.yaw - observation.base_in_world.yaw)) < 0.01


def test_odometry_starts_at_zero_and_drifts_continuously():
    simulation = Simulation(FLOOR, base_in_world=Pose2(3.0, 2.0, 1.0))
    start = simulation.step().base_in_world
    last, errors = Pose2(), []
    for _ in range(3000):
        observation = simulation.step(Twist2(0.3, 0.3))
        odometry = observation.odometry.base_in_odom
        assert last.distance_to(odometry) < 0.02
        errors.append((start @ odometry).distance_to(observation.base_in_world))
        last = odometry
    assert errors[0] < 0.01
    assert 0.02 < max(errors) < 2.0


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=list(ROBOTS))
def test_a_scan_equals_ray_casting_within_its_noise(robot):
    world = load_world(HOME)
    section = CrossSection(height=0.3)
    for part in world.bodies:
        section.add(part)
    simulation = Simulation(world, robot, base_in_world=Pose2(0.0, 0.0, 0.5))
    observation = next(seen for seen in (simulation.step() for _ in range(50)) if seen.scan is not None)
    scan, laser = observation.scan, observation.base_in_world @ observation.scan.laser_in_base
    expected, _ = cast_beams(
        section.segments(None), laser.x, laser.y, laser.yaw + scan.angle_min, scan.angle_increment,
        len(scan.ranges), robot.laser.sight,
    )  # fmt: skip
    hits = scan.hits & np.isfinite(expected)
    errors = scan.ranges[hits] - expected[hits]
    assert hits.sum() > 100
    assert np.median(np.abs(errors)) == pytest.approx(0.6745 * 0.01, rel=0.25)
    assert (np.abs(errors) < 0.05).mean() > 0.99, "but for beams that graze an edge"


def test_scans_and_odometry_come_at_their_rates():
    simulation = Simulation(FLOOR)
    seen = [simulation.step() for _ in range(50)]
    assert [one.stamp for one in seen] == pytest.approx(np.arange(1, 51) * 0.02)
    stamps = [one.scan.stamp for one in seen if one.scan is not None]
    assert stamps == pytest.approx(np.arange(1, 11) * 0.1)


def test_a_lidar_without_return_reads_infinity_and_a_depth_camera_nan():
    def last_scan(robot):
        return drive(Simulation(FLOOR, ROBOTS[robot]), None, 0.1).scan

    assert np.isposinf(last_scan("turtlebot_lidar").ranges).all()
    assert np.isnan(last_scan("turtlebot_kinect").ranges).all()


def test_the_same_seed_repeats_a_run_and_another_does_not():
    def run(seed):
        simulation = Simulation(load_world(HOME), seed=seed)
        return digest([simulation.step(Twist2(0.3, 0.2)) for _ in range(100)])

    assert run(1) == run(1)
    assert run(1) != run(2)


def test_the_noise_of_one_sensor_does_not_depend_on_another():
    def odometry(scan_rate):
        simulation = Simulation(FLOOR, settings=SimulationSettings(scan_rate=scan_rate), seed=3)
        return drive(simulation, Twist2(0.3, 0.2), 2.0).odometry

    assert odometry(10) == odometry(1)


def test_an_added_box_is_scanned_and_collided_with():
    simulation = Simulation(FLOOR, settings=EXACT)
    simulation.add_box("parcel", (0.4, 0.4, 0.5), Pose2(1.0, 0.0))
    scan = drive(simulation, None, 0.1).scan
    assert scan.ranges[180] == pytest.approx(0.8, abs=1e-3)
    assert drive(simulation, Twist2(0.7, 0.0), 2.0).contacts == ("parcel::link",)
    with pytest.raises(WorldError, match="parcel is in the world already"):
        simulation.add_box("parcel", (0.4, 0.4, 0.5), Pose2(2.0, 0.0))
    with pytest.raises(WorldError, match="flat: a box needs positive lengths"):
        simulation.add_box("flat", (0.4, 0.4, 0.0), Pose2(2.0, 0.0))


def test_a_light_box_is_pushed_along():
    simulation = Simulation(FLOOR, settings=EXACT)
    simulation.add_box("carton", (0.3, 0.3, 0.4), Pose2(0.6, 0.0), mass=0.3)
    assert drive(simulation, Twist2(0.4, 0.0), 3.0).base_in_world.x > 0.8


def test_the_robot_needs_free_space_and_a_floor_to_start():
    with pytest.raises(WorldError, match="inside wall::link"):
        Simulation(WALLED, base_in_world=Pose2(1.0, 0.0))
    with pytest.raises(WorldError, match="inside wardrobe::link"):
        Simulation(load_world(HOME), base_in_world=Pose2(-2.6, 4.99))
    with pytest.raises(WorldError, match="there is no floor"):
        Simulation(World("empty", (WALL,)))


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=list(ROBOTS))
@pytest.mark.parametrize("depth", [0.03, 0.06])
def test_a_robot_that_would_start_a_little_inside_a_wall_is_moved_out_of_it(robot, depth):
    reach = next(x for x in np.arange(0.5, 1.0, 0.01) if moved_out_of(robot, x))
    simulation = Simulation(WALLED, robot, EXACT, base_in_world=Pose2(reach + depth, 0.2, 0.3))
    observations = [simulation.step(Twist2()) for _ in range(100)]
    assert observations[0].base_in_world.distance_to(Pose2(reach, 0.2, 0.3)) < 0.07
    assert observations[-1].base_in_world.distance_to(observations[0].base_in_world) < 0.005
    assert max(seen.tilt for seen in observations) < 0.01


def moved_out_of(robot, x):
    """Return what a robot that would start at ``x`` is moved out of."""
    scene = Simulation(WALLED, base_in_world=Pose2(-2.0, 0.0), settings=EXACT).scene
    return scene.add_robot("other", robot, Pose2(x, 0.0))


def test_what_a_robot_is_moved_out_of_is_named():
    assert moved_out_of(ROBOTS["turtlebot_lidar"], 0.75) == ("wall::link",)
    assert moved_out_of(ROBOTS["turtlebot_lidar"], 0.5) == ()


def test_a_wall_ahead_triggers_the_centre_bumper_of_a_kobuki():
    simulation = Simulation(WALLED, settings=EXACT)
    simulation.scene.robot(ROBOT_NAME).enable_sensor("kobuki")
    assert simulation.step().kobuki == KobukiReading()
    pressed = set()
    for _ in range(200):
        pressed |= simulation.step(Twist2(0.5, 0.0)).kobuki.bumpers
    assert pressed == {CENTRE}


def test_an_edge_of_the_floor_triggers_cliff_sensors_and_then_wheel_drops_of_a_kobuki():
    table = body("table::link", Box((2.0, 2.0, 0.1)), pose3(0.0, 0.0, -0.05))
    simulation = Simulation(World("table", (table,)), settings=EXACT)
    simulation.scene.robot(ROBOT_NAME).enable_sensor("kobuki")
    first_cliff = None
    for _ in range(200):
        seen = simulation.step(Twist2(0.5, 0.0))
        if first_cliff is None and seen.kobuki.cliffs:
            first_cliff = seen
    assert first_cliff.kobuki.cliffs == {CENTRE}
    assert first_cliff.base_in_world.x == pytest.approx(1.0 - 0.156, abs=0.02)
    assert seen.kobuki.dropped == {0, 1}


def test_without_motor_power_commands_are_ignored():
    simulation = Simulation(FLOOR)
    robot = simulation.scene.robot("mobile_base")
    robot.switch_motors(False)
    assert abs(drive(simulation, Twist2(0.3, 0.0), 1.0).twist.v) < 1e-3
    robot.switch_motors(True)
    assert drive(simulation, Twist2(0.3, 0.0), 1.0).twist.v == pytest.approx(0.3, rel=0.02)
