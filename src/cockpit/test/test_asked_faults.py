"""Faults that are asked for at the page, and their kinds."""

import subprocess
import sys

import pytest

from cockpit import fault_kinds
from cockpit.errors import CockpitError
from cockpit.fault_kinds import known_kinds
from cockpit.models.faults import Asked, Kind, Wish
from sim_bridge.faults import KINDS

BIAS = Kind("scan_biased", "All beams are too long", "m", 0.1, -1.0, 1.0)
NAN = Kind("scan_nan", "All beams measure nothing", "", 1.0, 0.0, 1.0)


@pytest.fixture
def asked():
    asked = Asked()
    asked.know("one")
    return asked


@pytest.fixture
def unread():
    """As if no kinds had been read yet, before and after."""
    known_kinds.cache_clear()
    yield
    known_kinds.cache_clear()


def test_a_sentence_says_what_goes_wrong_and_how_much_it_can():
    assert BIAS.sentence() == "All beams are too long. Usually 0.1 m, from -1 to 1."
    assert NAN.sentence() == "All beams measure nothing."


def test_what_lasts_is_listed_with_the_seconds_left(asked):
    asked.add(Wish(BIAS, 5.0, -0.5), 10.0)
    asked.add(Wish(NAN, 0.0, 0.0), 12.0)
    assert asked.rows(12.04) == [("scan_biased", "-0.5 m", "3"), ("scan_nan", "", "for ever")]
    assert asked.rows(14.75) == [("scan_biased", "-0.5 m", "0.2"), ("scan_nan", "", "for ever")]
    assert asked.rows(15.0) == [("scan_nan", "", "for ever")]


def test_a_strength_of_0_is_the_usual_one(asked):
    asked.add(Wish(BIAS, 5.0, 0.0), 0.0)
    assert asked.rows(0.0) == [("scan_biased", "0.1 m", "5")]


def test_where_time_is_set_back_it_goes_wrong_once_more(asked):
    asked.add(Wish(NAN, 5.0, 0.0), 10.0)
    assert (asked.rows(20.0), asked.rows(1.0)) == ([], [])
    assert asked.rows(11.0) == [("scan_nan", "", "4")]


@pytest.mark.parametrize("other", [None, "another"])
def test_another_simulator_has_nothing_of_what_was_asked_for(asked, other):
    asked.add(Wish(NAN, 0.0, 0.0), 10.0)
    asked.know("one")
    assert asked.rows(11.0)
    asked.know(other)
    assert asked.rows(11.0) == []


def test_the_kinds_are_those_of_the_simulator(unread):
    kinds = known_kinds()
    assert list(kinds) == list(KINDS)
    for name, kind in kinds.items():
        assert (kind.unit, (kind.usual, kind.least, kind.largest)) == (KINDS[name].unit, KINDS[name].strength)
        assert len(kind.says) > 10


def test_the_kinds_are_known_without_loading_physics():
    script = (
        "import sys, cockpit.ros.tools.faults as tool; assert len(tool.known_kinds()) > 20;"
        "print({'pybullet', 'numba', 'sim_bridge.faults'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_kinds_that_cannot_be_read_are_told(unread, monkeypatch):
    monkeypatch.setattr(fault_kinds, "READING_SECONDS", 0.001)
    with pytest.raises(CockpitError, match="the kinds of faults cannot be read"):
        known_kinds()
    monkeypatch.undo()
    assert known_kinds()
