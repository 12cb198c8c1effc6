"""Fault injection: every kind has an effect while it is active, and errors in files are reported by line."""

import math
import sys
from dataclasses import replace

import numpy as np
import pytest

from planar import Pose2, SettingsError, Twist2
from sim_bridge import Simulation, SimulationSettings
from sim_bridge.errors import FaultError
from sim_bridge.faults import KINDS, Fault, FaultContext, FaultInjector, load_faults
from sim_bridge.faults.kind import FaultKind
from sim_bridge.geometry.shapes import Box, Plane
from sim_bridge.noise import noise_named
from sim_bridge.simulation import ROBOT_NAME
from sim_bridge.world import Body, Collision, World

EXACT = SimulationSettings(**noise_named("ideal"))
START, END, SECONDS = 1.0, 2.0, 3.0


def walled_world():
    floor = Body("floor::l", np.eye(4), (Collision(Plane(), np.eye(4)),))
    at = np.eye(4)
    at[:3, 3] = (6.0, 0.0, 0.5)
    wall = Body("wall::l", at, (Collision(Box((0.2, 8.0, 1.0)), np.eye(4)),))
    return World("w", (floor, wall))


def simulate(*faults, seed=0):
    """Observations of a robot that drives towards a wall."""
    injector = FaultInjector(faults, seed)
    simulation = Simulation(walled_world(), settings=EXACT, wrappers=injector.wrappers)
    seen = []
    for _ in range(round(SECONDS / simulation.step_seconds)):
        command = Twist2(0.3, math.sin(0.1 * len(seen)))
        seen.append(simulation.step(command))
        injector.update(seen[-1].stamp, FaultContext(simulation.scene, ROBOT_NAME, seen[-1].base_in_world))
    simulation.close()
    return seen


def essence(observations, since=0.0, until=math.inf):
    """All measurements of a run."""
    return [
        (one.stamp, one.base_in_world, one.odometry, None if one.scan is None else one.scan.ranges.tobytes(),
         None if one.scan is None else (one.scan.stamp, one.scan.angle_min))
        for one in observations
        if since <= one.stamp < until
    ]  # fmt: skip


@pytest.fixture(scope="module")
def clean():
    return simulate()


def test_there_are_25_kinds_and_more():
    assert len(KINDS) >= 25


@pytest.mark.parametrize("name", KINDS)
def test_a_kind_meets_the_contract(name, clean):
    usual, least, largest = KINDS[name].strength
    assert least <= usual <= largest
    assert KINDS[name].__doc__
    fault = Fault(name, START, END, usual, seed=4)
    seen = simulate(fault)
    assert essence(seen, until=START) == essence(clean, until=START), "nothing happens before it begins"
    assert essence(seen, START) != essence(clean, START), "something happens then"
    assert essence(seen) == essence(simulate(fault)), "the same seed gives the same fault"


def test_a_scan_is_correct_again_when_its_fault_ends():
    seen = simulate(Fault("scan_nan", START, END))
    shares = {one.stamp: np.isnan(one.scan.ranges).mean() for one in seen if one.scan is not None}
    assert {share for stamp, share in shares.items() if START <= stamp < END - 0.01} == {1.0}
    assert {share for stamp, share in shares.items() if stamp > END + 0.01} == {0.0}


def test_faults_add_up():
    seen = simulate(Fault("scan_biased", strength=0.1), Fault("scan_biased", strength=0.2))
    both, none = (next(one.scan for one in run if one.scan is not None) for run in (seen, simulate()))
    finite = np.isfinite(none.ranges)
    assert both.ranges[finite] - none.ranges[finite] == pytest.approx(0.3, abs=1e-5)


def test_a_late_scan_keeps_the_stamp_of_its_measurement():
    seen = simulate(Fault("scan_late", strength=0.5))
    ages = [one.stamp - one.scan.stamp for one in seen if one.scan is not None]
    assert ages == pytest.approx([0.5] * len(ages), abs=0.11)


def test_a_kidnapped_robot_is_displaced(clean):
    seen = simulate(Fault("kidnapped", START, strength=0.5))
    moved = seen[-1].base_in_world.distance_to(clean[-1].base_in_world)
    assert moved == pytest.approx(0.5, abs=0.1)
    assert seen[-1].odometry.base_in_odom.distance_to(clean[-1].odometry.base_in_odom) < 0.2


def test_a_kidnapped_robot_is_not_put_into_a_wall():
    """Found by falsify.sh: it counted as the robot's collision."""
    floor = Body("floor::l", np.eye(4), (Collision(Plane(), np.eye(4)),))
    at = np.eye(4)
    at[:3, 3] = (0.0, 0.6, 0.5)
    wall = Body("wall::l", at, (Collision(Box((8.0, 0.2, 1.0)), np.eye(4)),))
    simulation = Simulation(World("w", (floor, wall)), settings=EXACT)
    faults, touched, seen = FaultInjector([Fault("kidnapped", START, strength=0.5)]), [], None
    for _ in range(100):
        seen = simulation.step()
        touched += seen.contacts
        faults.update(seen.stamp, FaultContext(simulation.scene, ROBOT_NAME, seen.base_in_world))
    simulation.close()
    assert touched == []
    assert 0.15 < seen.base_in_world.y < 0.35


@pytest.mark.parametrize("kind", ["way_closed", "object_in_way"])
def test_several_obstacles_may_appear_and_may_be_deleted_meanwhile(kind):
    simulation, faults = Simulation(walled_world(), settings=EXACT), FaultInjector((), extendable=True)
    before = simulation.scene.models.names()
    for end, strength in ((0.5, 1.0), (0.5, 3.0), (9.0, 5.0)):
        faults.add(Fault(kind, 0.0, end, strength))
    stage = FaultContext(simulation.scene, ROBOT_NAME, Pose2())
    faults.update(0.1, stage)
    first, second, third = (name for name in simulation.scene.models.names() if name not in before)
    simulation.scene.remove_model(second)
    faults.update(0.6, stage)
    assert simulation.scene.models.names() == [*before[:-1], third, before[-1]]
    simulation.close()


def test_faults_are_read_from_a_file(tmp_path):
    path = tmp_path / "faults.yaml"
    path.write_text(
        "name: mission\nfaults:\n  - {kind: scan_frozen, start: 8, end: 12.5}\n  - {kind: kidnapped}\n"
    )
    assert load_faults(path) == (
        Fault("scan_frozen", 8.0, 12.5, 1.0),
        Fault("kidnapped", strength=KINDS["kidnapped"].strength[0]),
    )


@pytest.mark.parametrize(
    "entry, complaint",
    [
        ("{kind: scan_frosen}", r"faults\[1\].kind must be one of .*scan_frozen"),
        ("{start: 1}", r"faults\[1\].kind is missing"),
        ("{kind: kidnapped, strength: 99}", r"strength must be from -10 to 10"),
        ("{kind: kidnapped, start: -1}", "start must be not negative"),
        ("{kind: kidnapped, start: 2, end: 1}", "end must be after start"),
        ("{kind: kidnapped, seed: x}", "seed must be a whole number"),
        ("{kind: kidnapped, sed: 1}", 'unknown key "faults.1..sed"'),
        ("kidnapped", "must be a table"),
    ],
)
def test_an_error_is_reported_with_file_line_and_key(tmp_path, entry, complaint):
    path = tmp_path / "faults.yaml"
    path.write_text(f"faults:\n  - {entry}\n")
    with pytest.raises(SettingsError, match=f"faults.yaml:2: .*{complaint}"):
        load_faults(path)


def test_a_fault_may_be_added_later():
    faults = FaultInjector((), extendable=True)
    floor = Body("floor::l", np.eye(4), (Collision(Plane(), np.eye(4)),))
    simulation = Simulation(World("w", (floor,)), settings=EXACT, wrappers=faults.wrappers)
    while (seen := simulation.step(Twist2())).scan is None:
        pass
    assert not np.isnan(seen.scan.ranges).any()
    faults.add(Fault("scan_nan", start=seen.stamp))
    while (seen := simulation.step(Twist2())).scan is None:
        pass
    simulation.close()
    assert np.isnan(seen.scan.ranges).all()


class HalfRange(FaultKind):
    """All ranges are halved."""

    strength = (0.5, 0.1, 1.0)

    def scan(self, scan):
        return replace(scan, ranges=scan.ranges * np.float32(self._strength))


class Raises(FaultKind):
    """Fails."""

    def scan(self, scan):
        raise ZeroDivisionError("division by zero")


class InfiniteSpeed(FaultKind):
    """Returns an infinite wheel speed."""

    def wheel_speeds(self, left, right):
        return math.inf, right


class ReturnsNumber(FaultKind):
    """Returns no scan."""

    def scan(self, scan):
        return 3


class WithoutRange(FaultKind):
    """Has no range of strengths."""

    strength = 3.0


class WrongSignature(FaultKind):
    """Cannot be called."""

    def scan(self):
        return None


class NotDerived:
    """Has all methods of a fault but another base class."""

    strength = (1.0, 0.0, 1.0)
    scan = odometry = command = lambda self, value: value
    begin = end = lambda self, context: None
    wheel_speeds = lambda self, left, right: (left, right)  # noqa: E731

    def __init__(self, strength, rng):
        pass


@pytest.fixture
def dotted(monkeypatch):
    """This module under a dotted name; names its classes."""
    monkeypatch.setitem(sys.modules, "custom.faults", sys.modules[__name__])
    return lambda kind: f"custom.faults/{kind.__name__}"


def test_a_custom_kind_is_found_by_its_dotted_name(tmp_path, dotted, clean):
    path = tmp_path / "faults.yaml"
    path.write_text(f"faults:\n  - {{kind: {dotted(HalfRange)}, start: {START}, end: {END}}}\n")
    (fault,) = load_faults(path)
    assert fault.strength == 0.5
    seen = simulate(fault)
    assert essence(seen, until=START) == essence(clean, until=START)
    pairs = [
        (one.scan, other.scan) for one, other in zip(seen, clean) if one.scan and START <= one.stamp < END
    ]
    assert pairs
    for halved, whole in pairs:
        assert np.array_equal(halved.ranges, whole.ranges * np.float32(0.5))


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (Raises, "raised ZeroDivisionError: division by zero"),
        (InfiniteSpeed, "wheel_speeds returned"),
        (ReturnsNumber, "scan returned int, expected Scan or None"),
    ],
)
def test_failures_of_a_custom_kind_are_reported_with_its_name(kind, message, dotted):
    with pytest.raises(FaultError, match=f"^{dotted(kind)}:? {message}"):
        simulate(Fault(dotted(kind), 0.0))


@pytest.mark.parametrize(
    ("kind", "lacks"),
    [
        (WithoutRange, r"strength must be \(default, least, largest\), got 3.0"),
        (WrongSignature, r"it cannot be called as scan\(scan\)"),
        (NotDerived, "it is not derived from sim_bridge.faults.kind.FaultKind"),
    ],
)
def test_a_class_that_is_no_fault_is_refused_with_the_reason(kind, lacks, dotted, tmp_path):
    path = tmp_path / "faults.yaml"
    path.write_text(f"faults:\n  - {{kind: {dotted(kind)}}}\n")
    with pytest.raises(
        SettingsError, match=f"faults.yaml:2: .*kind cannot be used: {dotted(kind)} .*{lacks}"
    ):
        load_faults(path)
