import os
import signal
from contextlib import suppress

import pytest

from supervision import interruption


@pytest.fixture(autouse=True)
def _own_handlers(monkeypatch):
    monkeypatch.setattr(interruption, "_is_interrupted", False)
    before = {number: signal.getsignal(number) for number in interruption.SIGNALS}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", interruption.SIGNALS)
def test_an_interruption_that_a_library_swallows_is_not_lost(number):
    interruption.raise_when_interrupted()
    interruption.raise_if_interrupted()
    with suppress(BaseException):  # as in rosgraph.is_master_online
        os.kill(os.getpid(), number)
    with pytest.raises(interruption.RunInterruptedError, match="interrupted"):
        interruption.raise_if_interrupted()


def test_what_catches_every_exception_does_not_catch_an_interruption():
    interruption.raise_when_interrupted()
    with pytest.raises(interruption.RunInterruptedError), suppress(Exception):
        os.kill(os.getpid(), signal.SIGINT)


def test_further_signals_do_not_disturb_the_ending():
    interruption.raise_when_interrupted()
    with pytest.raises(interruption.RunInterruptedError):
        os.kill(os.getpid(), signal.SIGINT)
    os.kill(os.getpid(), signal.SIGTERM)
