"""Faults as data: every kind does what it says, while it lasts, and a file's mistakes are told by line."""

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


def played_world():
    floor = Body("floor::l", np.eye(4), (Collision(Plane(), np.eye(4)),))
    at = np.eye(4)
    at[:3, 3] = (6.0, 0.0, 0.5)
    wall = Body("wall::l", at, (Collision(Box((0.2, 8.0, 1.0)), np.eye(4)),))
    return World("w", (floor, wall))


def played(*faults, seed=0):
    """Observations of a robot that drives towards a wall."""
    going_wrong = FaultInjector(faults, seed)
    simulation = Simulation(played_world(), settings=EXACT, wrappers=going_wrong.wrappers)
    seen = []
    for _ in range(round(SECONDS / simulation.step_seconds)):
        command = Twist2(0.3, math.sin(0.1 * len(seen)))
        seen.append(simulation.step(command))
        going_wrong.update(seen[-1].stamp, FaultContext(simulation.scene, ROBOT_NAME, seen[-1].base_in_world))
    simulation.close()
    return seen


def essence(observations, since=0.0, until=math.inf):
    """All that can be told of a run."""
    return [
        (one.stamp, one.base_in_world, one.odometry, None if one.scan is None else one.scan.ranges.tobytes(),
         None if one.scan is None else (one.scan.stamp, one.scan.angle_min))
        for one in observations
        if since <= one.stamp < until
    ]  # fmt: skip


@pytest.fixture(scope="module")
def clean():
    return played()


def test_there_are_25_kinds_and_more():
    assert len(KINDS) >= 25


@pytest.mark.parametrize("name", KINDS)
def test_a_kind_keeps_the_contract(name, clean):
    usual, least, largest = KINDS[name].strength
    assert least <= usual <= largest
    assert KINDS[name].__doc__
    fault = Fault(name, START, END, usual, seed=4)
    seen = played(fault)
    assert essence(seen, until=START) == essence(clean, until=START), "nothing happens before it begins"
    assert essence(seen, START) != essence(clean, START), "something happens then"
    assert essence(seen) == essence(played(fault)), "the same seed gives the same fault"


def test_a_scan_is_whole_again_when_its_fault_is_over():
    seen = played(Fault("scan_nan", START, END))
    shares = {one.stamp: np.isnan(one.scan.ranges).mean() for one in seen if one.scan is not None}
    assert {share for stamp, share in shares.items() if START <= stamp < END - 0.01} == {1.0}
    assert {share for stamp, share in shares.items() if stamp > END + 0.01} == {0.0}


def test_faults_add_up():
    seen = played(Fault("scan_biased", strength=0.1), Fault("scan_biased", strength=0.2))
    both, none = (next(one.scan for one in run if one.scan is not None) for run in (seen, played()))
    finite = np.isfinite(none.ranges)
    assert both.ranges[finite] - none.ranges[finite] == pytest.approx(0.3, abs=1e-5)


def test_a_late_scan_keeps_the_stamp_of_its_measurement():
    seen = played(Fault("scan_late", strength=0.5))
    ages = [one.stamp - one.scan.stamp for one in seen if one.scan is not None]
    assert ages == pytest.approx([0.5] * len(ages), abs=0.11)


def test_a_robot_that_is_kidnapped_is_elsewhere(clean):
    seen = played(Fault("kidnapped", START, strength=0.5))
    moved = seen[-1].base_in_world.distance_to(clean[-1].base_in_world)
    assert moved == pytest.approx(0.5, abs=0.1)
    assert seen[-1].odometry.base_in_odom.distance_to(clean[-1].odometry.base_in_odom) < 0.2


def test_a_robot_that_is_kidnapped_is_not_set_down_in_a_wall():
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
def test_two_things_may_be_in_the_way_and_somebody_may_take_them_away(kind):
    simulation, faults = Simulation(played_world(), settings=EXACT), FaultInjector((), extendable=True)
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
        ("{kind: kidnapped, sed: 1}", "sed is not known"),
        ("kidnapped", "must be a table"),
    ],
)
def test_a_mistake_is_told_with_file_line_and_key(tmp_path, entry, complaint):
    path = tmp_path / "faults.yaml"
    path.write_text(f"faults:\n  - {entry}\n")
    with pytest.raises(SettingsError, match=f"faults.yaml:2: .*{complaint}"):
        load_faults(path)


def test_a_fault_may_come_later():
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


class Shouts(FaultKind):
    """Everything is half as far."""

    strength = (0.5, 0.1, 1.0)

    def scan(self, scan):
        return replace(scan, ranges=scan.ranges * np.float32(self._strength))


class Raises(FaultKind):
    """Fails."""

    def scan(self, scan):
        raise ZeroDivisionError("division by zero")


class SpinsForEver(FaultKind):
    """Gives wheels no speed."""

    def wheel_speeds(self, left, right):
        return math.inf, right


class AnswersANumber(FaultKind):
    """Gives no scan."""

    def scan(self, scan):
        return 3


class WithoutMeasure(FaultKind):
    """Has no range of strengths."""

    strength = 3.0


class HearsLess(FaultKind):
    """Cannot be called."""

    def scan(self):
        return None


class Stranger:
    """Has all methods and is none."""

    strength = (1.0, 0.0, 1.0)
    scan = odometry = command = lambda self, told: told
    begin = end = lambda self, stage: None
    wheel_speeds = lambda self, left, right: (left, right)  # noqa: E731

    def __init__(self, strength, rng):
        pass


@pytest.fixture
def own(monkeypatch):
    """This module under a dotted name; names its classes."""
    monkeypatch.setitem(sys.modules, "own.faults", sys.modules[__name__])
    return lambda kind: f"own.faults/{kind.__name__}"


def test_a_fault_of_other_people_is_known_by_its_dotted_name(tmp_path, own, clean):
    path = tmp_path / "faults.yaml"
    path.write_text(f"faults:\n  - {{kind: {own(Shouts)}, start: {START}, end: {END}}}\n")
    (fault,) = load_faults(path)
    assert fault.strength == 0.5
    seen = played(fault)
    assert essence(seen, until=START) == essence(clean, until=START)
    pairs = [
        (one.scan, other.scan) for one, other in zip(seen, clean) if one.scan and START <= one.stamp < END
    ]
    assert pairs
    for halved, whole in pairs:
        assert np.array_equal(halved.ranges, whole.ranges * np.float32(0.5))


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        (Raises, "raised ZeroDivisionError: division by zero"),
        (SpinsForEver, "wheel_speeds returned"),
        (AnswersANumber, "scan returned int, expected Scan or None"),
    ],
)
def test_what_goes_wrong_in_it_is_told_in_its_name(kind, said, own):
    with pytest.raises(FaultError, match=f"^{own(kind)}:? {said}"):
        played(Fault(own(kind), 0.0))


@pytest.mark.parametrize(
    ("kind", "lacks"),
    [
        (WithoutMeasure, r"strength must be \(default, least, largest\), got 3.0"),
        (HearsLess, r"it cannot be called as scan\(scan\)"),
        (Stranger, "it is not derived from sim_bridge.faults.kind.FaultKind"),
    ],
)
def test_what_is_no_fault_is_refused_with_what_it_lacks(kind, lacks, own, tmp_path):
    path = tmp_path / "faults.yaml"
    path.write_text(f"faults:\n  - {{kind: {own(kind)}}}\n")
    with pytest.raises(SettingsError, match=f"faults.yaml:2: .*kind cannot be used: {own(kind)} .*{lacks}"):
        load_faults(path)
