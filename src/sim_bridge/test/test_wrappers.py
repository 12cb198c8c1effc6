"""Wrappers of a robot's sensors and drive."""

import math

import numpy as np
import pytest

from planar import Twist2
from sim_bridge import ROBOTS, RobotWrappers, Simulation, SimulationSettings
from sim_bridge.geometry.shapes import Box, Plane
from sim_bridge.noise import noise_named
from sim_bridge.sensors.base import SensorWrapper
from sim_bridge.world import Body, Collision, World

EXACT = SimulationSettings(**noise_named("ideal"))
SCAN = ROBOTS["turtlebot_lidar"].scanner


class Delayed(SensorWrapper):
    """Delays readings by a number of physics steps."""

    def __init__(self, sensor, steps):
        super().__init__(sensor)
        self._steps = steps

    def schedule(self, settings):
        own = super().schedule(settings)
        return own._replace(delay=own.delay + self._steps)


class DroppingOut(SensorWrapper):
    """Drops a share of the readings."""

    def __init__(self, sensor, share, rng):
        super().__init__(sensor)
        self._share, self._rng = share, rng

    def measure(self, context):
        reading = super().measure(context)
        return None if self._rng.random() < self._share else reading


class Weak:
    """A drive whose wheels turn more slowly than commanded."""

    def __init__(self, drive, factor):
        self._drive, self._factor = drive, factor
        self.command, self.switch, self.halt = drive.command, drive.switch, drive.halt

    def wheel_speeds(self, seconds):
        left, right = self._drive.wheel_speeds(seconds)
        return self._factor * left, self._factor * right


@pytest.fixture
def observations():
    """Results of so many seconds with wrappers and a speed."""
    simulations = []

    def run(seconds, wrappers=RobotWrappers(), speed=0.0):
        floor = Body("floor::l", np.eye(4), (Collision(Plane(), np.eye(4)),))
        at = np.eye(4)
        at[:3, 3] = (4.0, 0.0, 0.5)
        wall = Body("wall::l", at, (Collision(Box((0.2, 5.0, 1.0)), np.eye(4)),))
        simulations.append(Simulation(World("w", (floor, wall)), settings=EXACT, wrappers=wrappers))
        steps = round(seconds / simulations[-1].step_seconds)
        return [simulations[-1].step(Twist2(speed, 0.0)) for _ in range(steps)]

    yield run
    for simulation in simulations:
        simulation.close()


def only(name, wrap):
    """Wraps the sensor of that name alone."""
    return RobotWrappers(sensor=lambda sensor: wrap(sensor) if sensor.name == name else sensor)


def readings_of(seen):
    """When scans came, and when they were measured."""
    return [(one.stamp, one.readings[SCAN].stamp) for one in seen if SCAN in one.readings]


@pytest.mark.parametrize("steps, later", [(12, 12), (3, 4), (5, 8)])
def test_a_delayed_scan_comes_later_and_carries_the_stamp_of_its_measurement(observations, steps, later):
    """Readings are returned with the odometry, after each fourth step."""
    delayed = readings_of(observations(1.0, only(SCAN, lambda sensor: Delayed(sensor, steps))))
    prompt = readings_of(observations(1.0))
    assert [measured for _, measured in delayed] == [measured for _, measured in prompt][: len(delayed)]
    assert all(came - measured == pytest.approx(later / EXACT.physics_rate) for came, measured in delayed)
    assert all(came == pytest.approx(measured) for came, measured in prompt)


def test_a_scanner_that_drops_out_leaves_all_else_as_it_was(observations):
    rng = np.random.default_rng(0)
    seen = observations(10.0, only(SCAN, lambda sensor: DroppingOut(sensor, 0.5, rng)), speed=0.2)
    clean = observations(10.0, speed=0.2)
    assert 0.3 < len(readings_of(seen)) / len(readings_of(clean)) < 0.7
    assert [one.base_in_world for one in seen] == [one.base_in_world for one in clean]


def test_odometry_that_drops_out_stays_what_it_was_last(observations):
    seen = observations(1.0, only("odometry", lambda sensor: DroppingOut(sensor, 1.0, _Always())), speed=0.2)
    assert seen[-1].base_in_world.x > 0.1
    assert seen[-1].odometry.base_in_odom.x == 0.0
    assert "odometry" not in seen[-1].readings


def test_a_wrapped_drive_changes_how_the_robot_moves(observations):
    whole = observations(3.0, speed=0.3)[-1].base_in_world.x
    half = observations(3.0, RobotWrappers(drive=lambda drive: Weak(drive, 0.5)), speed=0.3)[
        -1
    ].base_in_world.x
    assert math.isclose(half, 0.5 * whole, rel_tol=0.05)


class _Always:
    """A random generator whose draws are all 0."""

    @staticmethod
    def random():
        return 0.0


def test_motors_are_set_fifty_times_a_second_and_commands_are_ramped_as_before():
    asked = []

    class Counting(Weak):
        def wheel_speeds(self, seconds):
            asked.append(seconds)
            return super().wheel_speeds(seconds)

    floor = World("floor", (Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),)),))
    for rate in (200, 1000):
        settings = SimulationSettings(**{**noise_named("ideal"), "physics_rate": rate})
        wrappers = RobotWrappers(drive=lambda drive: Counting(drive, 1.0))
        simulation = Simulation(floor, settings=settings, wrappers=wrappers)
        asked.clear()
        for _ in range(round(1.0 / simulation.step_seconds)):
            seen = simulation.step(Twist2(0.3, 0.0))
        assert asked == pytest.approx([0.02] * 50)
        assert seen.twist.v == pytest.approx(0.3, abs=0.01)
        simulation.close()
