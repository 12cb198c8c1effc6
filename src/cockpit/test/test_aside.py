import threading

import pytest

from cockpit.errors import CockpitError
from cockpit.ros.aside import Aside


def test_one_thing_at_a_time_or_the_last_instead_of_the_one_before():
    aside, go_on, has_gone_on = Aside(), threading.Event(), threading.Event()

    def hang():
        go_on.wait(10.0)
        threading.Timer(0.05, has_gone_on.set).start()
        return "first"

    aside.start(hang)
    with pytest.raises(CockpitError):
        aside.start(lambda: "refused")
    aside.restart(lambda: "last")
    go_on.set()
    assert has_gone_on.wait(10.0)
    assert aside.take() == ["last"]
    assert aside.take() == []
