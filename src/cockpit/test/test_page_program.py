"""Programs that serve a page: their URL, and why there is none."""

import time

import pytest

from cockpit.errors import CockpitError, PortError
from cockpit.page_program import PageProgram


def program(script, **options):
    return PageProgram(["sh", "-c", script], "edit the home", **options)


def test_the_url_is_known_once_it_is_printed():
    served = program("sleep 0.3; echo edit the home: http://127.0.0.1:1/?token=x; sleep 60")
    assert served.printed_url() is None
    assert served.wait_for_url(20.0) == "http://127.0.0.1:1/?token=x"
    assert served.is_running
    served.close()
    assert not served.is_running


def test_a_program_that_ends_without_a_page_states_its_last_line():
    with pytest.raises(CockpitError, match=r"edit the home: its page is not served \(no room\)"):
        program("echo no room; exit 1").wait_for_url(20.0)


def test_an_error_of_a_program_is_its_own():
    with pytest.raises(PortError, match="^8080 is taken$"):
        program("echo error: 8080 is taken; exit 2").wait_for_url(20.0)


def test_a_page_that_does_not_come_is_not_waited_for():
    with pytest.raises(CockpitError, match="no page within 0.2 s"):
        program("sleep 60").wait_for_url(0.2)


def test_a_program_that_does_not_end_is_killed():
    started = time.monotonic()
    stubborn = program("trap '' TERM; echo edit the home: http://x; while true; do sleep 0.1; done")
    stubborn.wait_for_url(20.0)
    stubborn.close(0.3)
    assert not stubborn.is_running
    assert time.monotonic() - started < 15.0
