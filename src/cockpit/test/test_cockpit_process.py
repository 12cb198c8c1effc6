"""How the process of the cockpit fails to start."""

import time

import pytest

from cockpit.errors import CockpitError, PortError
from cockpit.process import FREE_PORT, CockpitProcess


def test_a_cockpit_that_dies_as_it_starts_is_not_waited_for(tmp_path):
    started = time.monotonic()
    with pytest.raises(CockpitError, match=r"did not start, see .*cockpit\.log"):
        CockpitProcess(
            FREE_PORT, tmp_path / "cockpit.log", prefix=["sh", "-c", "echo Traceback; sleep 0.5; exit 1"]
        )
    assert time.monotonic() - started < 20.0
    assert (tmp_path / "cockpit.log").read_text() == "Traceback\n"


def test_the_last_output_of_a_crashed_cockpit_is_logged(tmp_path):
    with pytest.raises(PortError, match="^8080 is taken$"):
        CockpitProcess(FREE_PORT, tmp_path / "log", prefix=["sh", "-c", "echo error: 8080 is taken; exit 2"])
