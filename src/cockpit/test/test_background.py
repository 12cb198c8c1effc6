import threading

import pytest

from cockpit.errors import CockpitError
from cockpit.ros.background import BackgroundCall


def test_one_call_runs_at_a_time_and_a_restart_discards_the_previous_one():
    background, go_on, has_gone_on = BackgroundCall(), threading.Event(), threading.Event()

    def hang():
        go_on.wait(10.0)
        threading.Timer(0.05, has_gone_on.set).start()
        return "first"

    background.start(hang)
    with pytest.raises(CockpitError):
        background.start(lambda: "refused")
    background.restart(lambda: "last")
    go_on.set()
    assert has_gone_on.wait(10.0)
    assert background.results() == ["last"]
    assert background.results() == []
