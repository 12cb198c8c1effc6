"""Idle time between ticks of nodes: its duration, held ticks, what may pass at once, calls that end it."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from std_msgs.msg import Header

from planar import Twist2
from planar_ros.lockstep.transport import is_read_only
from sim_bridge import Simulation
from sim_bridge.driving.idle_time import LONGEST_SECONDS, idle_seconds, last_steps
from sim_bridge.geometry.shapes import Plane
from sim_bridge.lock_step import LockStepCoordinator
from sim_bridge.pacing import FORGIVEN_DELAY, Pacer
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.timing import idle_time
from sim_bridge.simulation import ROBOT_NAME
from sim_bridge.world import Body, Collision, World


@pytest.mark.parametrize(
    ("until", "seconds"), [(110.0, 10.0), (110.05, 10.0), (109.99, 9.9), (500.0, LONGEST_SECONDS)]
)
def test_idle_time_ends_at_the_last_tick_before_something_is_due(until, seconds):
    assert idle_seconds(100.0, until, 0.1) == pytest.approx(seconds)


@pytest.mark.parametrize("until", [90.0, 100.0, 102.9])
def test_a_short_idle_time_is_none(until):
    assert idle_seconds(100.0, until, 0.1) == 0.0


def test_the_last_second_is_stepped():
    assert [last_steps(step) for step in (0.02, 0.1, 0.3)] == [50, 10, 4]


def test_no_tick_begins_while_ticks_are_held_and_those_afterwards_are_at_multiples_of_the_period():
    coordinator = LockStepCoordinator(0.1)
    coordinator.add_member("/service", 0.1)
    assert coordinator.begin_tick(1.0) == (1, True) and coordinator.is_tick(1.0)
    coordinator.hold(59.9)
    for stamp in (1.1, 30.0, 59.88):
        assert coordinator.begin_tick(stamp) is None and not coordinator.is_tick(stamp)
    assert coordinator.begin_tick(59.9) == (2, False)
    assert coordinator.begin_tick(59.98) is None
    assert coordinator.begin_tick(60.0) == (3, False)


def test_a_node_that_joins_meanwhile_and_a_restart_of_time_end_the_hold():
    coordinator = LockStepCoordinator(0.1)
    coordinator.add_member("/service", 0.1)
    coordinator.begin_tick(1.0)
    coordinator.hold(60.0)
    coordinator.add_member("/amcl", 0.1)
    assert coordinator.begin_tick(1.02) == (2, True)
    coordinator.reset_time()
    assert coordinator.begin_tick(0.0) == (3, True)
    assert coordinator.begin_tick(0.1) == (4, False)


@pytest.mark.parametrize(
    ("speed", "seconds"), [(0.0, math.inf), (0.5, 0.0), (1.0, 0.0), (1000.0, 1000.0 * FORGIVEN_DELAY)]
)
def test_as_much_passes_at_once_as_the_speed_allows_within_the_forgiven_delay(speed, seconds):
    assert Pacer(speed).longest_jump == pytest.approx(seconds)


def test_nothing_passes_at_once_beside_nodes_that_are_not_synchronised():
    pacer = Pacer(0.0, ["amcl"])
    assert pacer.longest_jump == 0.0
    pacer.synchronised_nodes = frozenset(["amcl"])
    assert pacer.longest_jump == math.inf
    pacer.limited_by = frozenset(["camera"])
    assert pacer.longest_jump == 0.0
    pacer.limited_by = frozenset()
    pacer.follow("laser")
    assert pacer.longest_jump == 0.0


def test_calls_that_may_change_the_scene_are_counted_when_they_are_run():
    calls = CallQueue()
    calls.submit(lambda: None, acts=False)
    calls.submit(lambda: None)
    assert calls.acted == 0
    calls.run_pending()
    assert calls.acted == 1


@pytest.mark.parametrize("service", ["/gazebo/get_model_state", "/gazebo/pause_physics", "/sim_bridge/step"])
def test_services_that_change_nothing(service):
    assert is_read_only(service)


@pytest.mark.parametrize("service", ["/gazebo/set_model_state", "/gazebo/spawn_sdf_model"])
def test_services_that_change_the_scene(service):
    assert not is_read_only(service)


class IdleBench:
    """A robot that stands, and a node that states at each tick until when it has nothing to do."""

    def __init__(self, monkeypatch, skips=True):
        topic = SimpleNamespace(publish=lambda value: None)
        monkeypatch.setattr(rospy, "Publisher", lambda *arguments, **named: topic)
        monkeypatch.setattr(rospy, "Subscriber", lambda *arguments, **named: None)
        monkeypatch.setattr(rospy, "get_name", lambda: "/sim_bridge")
        monkeypatch.setattr(idle_time, "outgoing", lambda: [(name, "/odom", None) for name in self.listeners])
        floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
        self.scene = Simulation(World("floor", (floor,))).scene
        self.period, self.members, self.receivers = 0.1, {"/service"}, {"/service", "/referee"}
        self.listeners, self.until, self.faulty, self.longest, self.is_alone = (
            {"/referee"},
            1e4,
            False,
            math.inf,
            True,
        )
        self.commands_received, self.ticks, self.taken, self._held = 0, [], 0, -1.0
        self._is_delivered = True
        self.calls = CallQueue()
        self._idle = idle_time.IdleTime(self.scene, self, self, self, self.calls, skips)

    def run(self, until):
        """Step until a simulated time; return the number of steps taken."""
        before = self.taken
        while self.scene.stamp < until - 1e-6:
            self._begin_tick(self.scene.stamp)
            self._idle.skip(count) if (count := self._idle.update(self.longest, self.is_alone)) else None
            self.scene.step()
            self.taken += 1
        return self.taken - before

    def command(self, twist):
        self.commands_received += 1
        self.scene.robot(ROBOT_NAME).command(twist)

    # -- LockStep

    def _begin_tick(self, stamp):
        if stamp > self._held - 1e-6 and (not self.ticks or stamp > self.ticks[-1] + self.period - 1e-6):
            self.deliver(stamp)
            self.ticks.append(stamp)
            self._is_delivered = False

    def is_tick(self, stamp):
        return bool(self.ticks) and stamp == self.ticks[-1]

    def deliver(self, _stamp):
        if not self._is_delivered and self.until > self.ticks[-1]:
            self._idle._on_idle(Header(stamp=rospy.Time.from_sec(self.until), frame_id="service"))
        self._is_delivered = True
        return True

    def hold(self, until):
        self._held = until

    # -- RobotManager, FaultServer

    def skip(self, count):
        self.scene.skip(count)

    def are_inactive(self, _start, _end):
        return not self.faulty


@pytest.fixture
def bench(monkeypatch):
    made = IdleBench(monkeypatch)
    made.run(10.0)  # a robot counts as standing after 6 s
    yield made
    made.scene.close()


def test_of_an_hour_the_last_second_of_each_minute_is_stepped_and_has_two_ticks(bench):
    ticks = len(bench.ticks)
    assert bench.run(3610.0) < 61 * 60
    assert len(bench.ticks) - ticks == pytest.approx(2 * 60, abs=12)


def test_time_stops_at_the_last_tick_before_something_is_due(bench):
    bench.until = 500.05
    bench.run(600.0)
    assert any(stamp == pytest.approx(500.0) for stamp in bench.ticks)
    assert [stamp for stamp in bench.ticks if stamp > 500.2] == pytest.approx(np.arange(500.3, 600.0, 0.1))


@pytest.mark.parametrize(
    "reason",
    [
        {"until": 0.0},
        {"faulty": True},
        {"longest": 0.0},
        {"is_alone": False},
        {"listeners": {"/referee", "/rviz"}},
        {"members": set()},
    ],
    ids=lambda reason: next(iter(reason)),
)
def test_no_step_is_skipped_while_there_is_a_reason(bench, reason):
    bench.run(70.0)
    vars(bench).update(reason)
    bench.run(140.0)
    assert bench.run(200.0) == 60 * 50


def test_no_step_is_skipped_within_a_second_of_a_command_or_call(bench):
    bench.run(70.0)
    for act in (lambda: bench.command(Twist2()), lambda: bench.calls.submit(int)):
        act()
        bench.calls.run_pending()
        now = bench.scene.stamp
        assert bench.run(now + 0.98) == 49
        assert bench.run(now + 300.0) < 3000


def test_a_robot_that_is_commanded_drives_and_is_stepped(bench):
    bench.run(70.0)
    for _ in range(20):
        bench.command(Twist2(0.2))
        now = bench.scene.stamp
        assert bench.run(now + 0.1) == 5
    assert bench.scene.robot(ROBOT_NAME).vehicle.state().pose[0, 3] > 0.1


def test_what_passes_at_once_is_limited(bench):
    bench.longest = 10.0
    before, ticks = bench.run(70.0), len(bench.ticks)
    assert before > 0 and bench.run(670.0) == pytest.approx(60 * 50, rel=0.2)
    assert max(np.diff(bench.ticks[ticks:])) < 10.0


def test_without_skipping_all_steps_are_taken_and_the_battery_is_the_same(monkeypatch):
    charges = []
    for skips in (True, False):
        made = IdleBench(monkeypatch, skips)
        made.until = 350.0
        steps = made.run(400.0)
        assert (steps == 400 * 50) is not skips
        charges.append(made.scene.step()[ROBOT_NAME].power)
        made.scene.close()
    assert charges[0] == charges[1]
