"""Waiting for a condition with a time-out."""

import time

PATIENCE_SECONDS = 20.0


def wait_until(what, is_met, seconds=PATIENCE_SECONDS, pause=0.01):
    """Wait until ``is_met()``; fail after ``seconds`` of wall time, polling every ``pause`` seconds."""
    deadline = time.monotonic() + seconds
    while not is_met():
        assert time.monotonic() < deadline, f"timed out after {seconds:g} s waiting for {what}"
        time.sleep(pause)
