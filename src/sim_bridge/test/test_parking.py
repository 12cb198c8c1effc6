"""Idle time: physics stops while nothing moves, steps are skipped, and the run goes on with the same bits."""

import time

import numpy as np
import pytest

from planar import Pose2, Twist2
from sim_bridge import Episode, EpisodeHooks, Simulation, SimulationSettings
from sim_bridge.docks import with_dock
from sim_bridge.doorway import Door
from sim_bridge.faults import Fault, FaultInjector
from sim_bridge.geometry.shapes import Plane
from sim_bridge.noise import noise_named
from sim_bridge.people.walker import Walker
from sim_bridge.scripted_trajectories import ModelMove
from sim_bridge.simulation import box_on_floor
from sim_bridge.world import Body, Collision, World

FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
WALLS = tuple(
    box_on_floor(f"wall{n}", size, pose)
    for n, (size, pose) in enumerate(
        (
            ((0.1, 8.0, 1.0), Pose2(-4.0, 0.0)),
            ((0.1, 8.0, 1.0), Pose2(4.0, 0.0)),
            ((8.0, 0.1, 1.0), Pose2(0.0, 4.0)),
            ((8.0, 0.1, 1.0), Pose2(0.0, -4.0)),
        )
    )
)
ROOM = World("room", (FLOOR, *WALLS))
PERSON = Walker("anna", np.array([[2.0, 2.0], [2.0, -2.0], [-2.0, 2.5]]), rest=3.0)
DOOR = Door("door", Pose2(0.0, -3.0), 1.0, start=30.0, end=70.0)
BOX = box_on_floor("crate", (0.4, 0.4, 0.6), Pose2(1.5, 1.5))
MOVED = World("moved", (*ROOM.bodies, BOX), moves=(ModelMove(60.0, "crate", Pose2(2.5, -1.5)),))
BUSY = World("busy", ROOM.bodies, walkers=(PERSON,), doors=(DOOR,))
# A robot counts as standing after 6 s.
STANDING = 6.5


class Recorder(EpisodeHooks):
    """Records all that is measured, as comparable values."""

    def __init__(self):
        self.steps = []

    def after_step(self, episode, step):
        scans = [np.asarray(scan.ranges).tobytes() for scan in step.scans]
        people = episode.simulation.scene.crowd.rows.tobytes()
        self.steps.append((step.stamp, step.base_in_world, step.odometry, step.power, scans, people))


def run(world, skips, noise="high", seconds=100.0, faults=None):
    """Stand, idle and drive; return what was measured after the idle time."""
    settings, recorder = SimulationSettings(**noise_named(noise)), Recorder()
    wrappers = {} if faults is None else {"wrappers": faults.wrappers}
    simulation = Simulation(world, settings=settings, seed=5, **wrappers)
    scene = simulation.scene
    if not skips:
        scene.skip = lambda count: [scene.step() for _ in range(count)] and None
    episode = Episode(simulation, 0.1, 0.1, faults, hooks=(recorder,))
    episode.command = Twist2(0.2, 0.3)
    for _ in range(20):
        episode.advance()
    episode.command = Twist2()
    end = None
    while end is None or scene.stamp < end:
        episode.advance()
        begin = scene.stamp
        if episode.idle(begin + seconds if end is None else end) and end is None:
            end = begin + seconds
    idle_until = scene.stamp
    recorder.steps.clear()
    for number in range(60):
        episode.command = Twist2(0.25, 0.5 if number % 20 < 10 else -0.5)
        episode.advance()
    simulation.close()
    return idle_until, recorder.steps


@pytest.mark.parametrize("noise", ["turtlebot", "high"])
@pytest.mark.parametrize("world", [ROOM, BUSY, MOVED], ids=lambda world: world.name)
def test_the_run_after_an_idle_time_has_the_same_bits_as_if_it_had_been_stepped(world, noise):
    skipped, stepped = (run(world, skips, noise) for skips in (True, False))
    assert skipped[0] > 100.0 and skipped == stepped


def test_idle_times_of_another_length_give_other_noise():
    first, second = ([step[4] for step in run(ROOM, True, seconds=seconds)[1]] for seconds in (50.0, 60.0))
    assert any(first) and first != second


def test_people_and_doors_move_and_the_battery_empties_meanwhile():
    simulation = Simulation(BUSY)
    episode = Episode(simulation, 0.1)
    while not episode.idle(simulation.scene.stamp + 20.0):
        before = episode.advance()
    charge, rows = before.power.charge, simulation.scene.crowd.rows.copy()
    door = simulation.scene.models.link_state(DOOR.link).pose[0, 3]
    episode.idle(simulation.scene.stamp + 30.0)
    assert episode.advance().power.charge < charge
    assert np.abs(simulation.scene.crowd.rows - rows).max() > 0.1
    assert abs(simulation.scene.models.link_state(DOOR.link).pose[0, 3] - door) > 100.0
    simulation.close()


def test_a_docked_robot_charges_while_steps_are_skipped():
    simulation = Simulation(
        with_dock(ROOM, Pose2(-0.18, 0.0)),
        settings=SimulationSettings(battery_charge=0.5),
        base_in_world=Pose2(0.02, 0.0, 3.141592653589793),
    )
    episode = Episode(simulation, 0.1)
    while not episode.idle(simulation.scene.stamp + 1800.0):
        episode.advance()
    power = episode.advance().power
    assert power.charger == 6 and power.charge > 0.9
    simulation.close()


def test_nothing_is_skipped_while_the_robot_or_another_body_moves():
    simulation = Simulation(ROOM)
    episode = Episode(simulation, 0.1)
    episode.command = Twist2(0.2)
    for _ in range(100):
        episode.advance()
    assert not episode.idle(100.0) and simulation.scene.stamp == pytest.approx(10.0)
    episode.command = Twist2()
    for _ in range(100):
        episode.advance()
    simulation.scene.add([box_on_floor("falling", (0.2, 0.2, 0.2), Pose2(2.0, 2.0), 1.0, height=2.0)])
    episode.advance()
    assert not episode.idle(100.0)
    simulation.close()


@pytest.mark.parametrize("kind", ["scan_noisy", "odometry_slipping", "wheel_weak"])
def test_faults_begin_and_end_as_if_the_idle_time_had_been_stepped(kind):
    fault = Fault(kind, 60.0, 112.0, 0.5)
    skipped, stepped = (run(ROOM, skips, faults=FaultInjector([fault], 1)) for skips in (True, False))
    assert skipped == stepped and skipped != run(ROOM, True)


def test_an_idle_time_ends_when_a_model_is_moved():
    simulation = Simulation(MOVED)
    episode = Episode(simulation, 0.1)
    while not episode.idle(100.0):
        episode.advance()
    models = simulation.scene.models
    assert simulation.scene.stamp == pytest.approx(60.0, abs=0.1)
    assert models.state("crate").pose[0, 3] == pytest.approx(1.5)
    episode.advance()
    assert models.state("crate").pose[:2, 3] == pytest.approx((2.5, -1.5), abs=1e-3)
    simulation.close()


def test_a_command_ends_the_idle_time():
    simulation = Simulation(ROOM)
    for _ in range(round(STANDING / simulation.step_seconds)):
        simulation.step(Twist2())
    assert simulation.park()
    for _ in range(100):
        step = simulation.step(Twist2(0.2))
    assert step.base_in_world.x > 0.1
    simulation.close()


def test_an_idle_hour_takes_less_than_a_thousandth_of_it():
    simulation = Simulation(ROOM)
    episode = Episode(simulation, 0.1)
    while not episode.idle(simulation.scene.stamp + 1.0):
        episode.advance()
    begin = time.process_time()
    assert episode.idle(simulation.scene.stamp + 3600.0)
    assert time.process_time() - begin < 3.6
    simulation.close()
