"""Episode: control periods, the latency of commands, hooks and faults."""

import numpy as np
import pytest

from planar import Pose2, Twist2
from sim_bridge import Episode, EpisodeHooks, Simulation
from sim_bridge.faults import Fault, FaultInjector
from sim_bridge.geometry.shapes import Plane
from sim_bridge.world import Body, Collision, World

FLOOR = World("floor", (Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),)),))


class Recorder(EpisodeHooks):
    """Records the calls, and commands a speed at each tick."""

    def __init__(self):
        self.calls, self.speeds = [], []

    def before_step(self, episode):
        self.calls.append("before")

    def after_step(self, episode, step):
        self.calls.append("after")
        self.speeds.append(step.twist.v)

    def at_tick(self, episode, step):
        self.calls.append("tick")
        episode.command = Twist2(0.2, 0.0)


@pytest.fixture
def simulation():
    simulation = Simulation(FLOOR)
    yield simulation
    simulation.close()


def test_hooks_are_called_around_each_step_and_once_a_control_period(simulation):
    recorder = Recorder()
    step = Episode(simulation, 0.06, hooks=(recorder,)).advance()
    assert recorder.calls == ["before", "after"] * 3 + ["tick"]
    assert step.stamp == pytest.approx(0.06)


@pytest.mark.parametrize("latency, steps", [(0.0, 5), (0.04, 7), (0.1, 10)])
def test_a_command_takes_effect_after_the_latency(simulation, latency, steps):
    recorder = Recorder()
    episode = Episode(simulation, 0.1, latency, hooks=(recorder,))
    for _ in range(3):
        episode.advance()
    assert [abs(speed) > 0.005 for speed in recorder.speeds[:steps]] == [False] * steps
    assert recorder.speeds[steps + 1] > 0.005


def test_an_episode_runs_until_it_is_over(simulation):
    recorder = Recorder()
    step = Episode(simulation, 0.1, hooks=(recorder,)).run(lambda: recorder.calls.count("tick") == 4)
    assert step.stamp == pytest.approx(0.4)


def test_faults_of_the_environment_begin_when_they_are_due():
    faults = FaultInjector([Fault("kidnapped", start=0.1, strength=0.5)])
    simulation = Simulation(FLOOR, wrappers=faults.wrappers)
    episode = Episode(simulation, 0.1, faults=faults)
    assert episode.advance().base_in_world.distance_to(Pose2()) < 0.01
    assert episode.advance().base_in_world.distance_to(Pose2()) == pytest.approx(0.5, abs=0.02)
    simulation.close()
