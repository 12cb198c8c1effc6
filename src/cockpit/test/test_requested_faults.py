"""Faults requested on the page, and their kinds."""

import subprocess
import sys

import pytest

import cockpit.fault_kinds
from cockpit.errors import CockpitError
from cockpit.fault_kinds import fault_kinds as read_fault_kinds
from cockpit.models.faults import FaultKindInfo, FaultRequest, RequestedFaults
from sim_bridge.faults import KINDS

BIAS = FaultKindInfo("scan_biased", "All beams are too long", "m", 0.1, -1.0, 1.0)
NAN = FaultKindInfo("scan_nan", "All beams measure nothing", "", 1.0, 0.0, 1.0)


@pytest.fixture
def requested():
    requested = RequestedFaults()
    requested.set_simulator("one")
    return requested


@pytest.fixture
def unread():
    """As if no kinds had been read yet, before and after."""
    read_fault_kinds.cache_clear()
    yield
    read_fault_kinds.cache_clear()


def test_the_description_of_a_kind_names_its_usual_strength_and_range():
    assert BIAS.sentence() == "All beams are too long. Usually 0.1 m, from -1 to 1."
    assert NAN.sentence() == "All beams measure nothing."


def test_active_faults_are_listed_with_the_seconds_left(requested):
    requested.add(FaultRequest(BIAS, 5.0, -0.5), 10.0)
    requested.add(FaultRequest(NAN, 0.0, 0.0), 12.0)
    assert requested.rows(12.04) == [("scan_biased", "-0.5 m", "3"), ("scan_nan", "", "forever")]
    assert requested.rows(14.75) == [("scan_biased", "-0.5 m", "0.2"), ("scan_nan", "", "forever")]
    assert requested.rows(15.0) == [("scan_nan", "", "forever")]


def test_a_strength_of_0_is_the_usual_one(requested):
    requested.add(FaultRequest(BIAS, 5.0, 0.0), 0.0)
    assert requested.rows(0.0) == [("scan_biased", "0.1 m", "5")]


def test_a_fault_is_active_again_when_time_jumps_back(requested):
    requested.add(FaultRequest(NAN, 5.0, 0.0), 10.0)
    assert (requested.rows(20.0), requested.rows(1.0)) == ([], [])
    assert requested.rows(11.0) == [("scan_nan", "", "4")]


@pytest.mark.parametrize("other", [None, "another"])
def test_another_simulator_has_no_requested_faults(requested, other):
    requested.add(FaultRequest(NAN, 0.0, 0.0), 10.0)
    requested.set_simulator("one")
    assert requested.rows(11.0)
    requested.set_simulator(other)
    assert requested.rows(11.0) == []


def test_the_kinds_are_those_of_the_simulator(unread):
    kinds = read_fault_kinds()
    assert list(kinds) == list(KINDS)
    for name, kind in kinds.items():
        assert (kind.unit, (kind.usual, kind.least, kind.largest)) == (KINDS[name].unit, KINDS[name].strength)
        assert len(kind.description) > 10


def test_the_kinds_are_known_without_loading_physics():
    script = (
        "import sys, cockpit.ros.tools.faults as tool; assert len(tool.fault_kinds()) > 20;"
        "print({'pybullet', 'numba', 'sim_bridge.faults'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_kinds_that_cannot_be_read_are_an_error(unread, monkeypatch):
    monkeypatch.setattr(cockpit.fault_kinds, "READING_SECONDS", 0.001)
    with pytest.raises(CockpitError, match="the kinds of faults cannot be read"):
        read_fault_kinds()
    monkeypatch.undo()
    assert read_fault_kinds()
