"""Traces of runs and their first difference."""

import errno
import tempfile

import pytest

from evaluation.trace import (
    Trace,
    TraceDifference,
    TraceEntry,
    first_difference,
    hash_of,
    read_trace,
    write_trace,
)
from planar import FileWriteError, SettingsError

SECOND = 1_000_000_000


def trace_of(poses, end=10, marks=("marker shown",), **how):
    trace = Trace(**how)
    for stamp, text in poses:
        trace.add(TraceEntry(stamp * SECOND, "/truth", "/sim_bridge", text))
    trace.start(2 * SECOND)
    trace.end(TraceEntry(end * SECOND, "/state", "/pick_objects", "delivered"))
    for mark in marks:
        trace.add_unstamped(mark)
    return trace


def test_a_trace_goes_from_the_first_goal_to_the_last_outcome():
    lines = trace_of([(1, "before"), (3, "on the way"), (2, "start"), (11, "after")]).lines()
    assert [line.split(maxsplit=3)[3] for line in lines[:3]] == ["start", "on the way", "delivered"]
    assert lines[3:] == ["marker shown"]


def test_the_order_in_which_messages_come_does_not_count():
    poses = [(2, "a"), (3, "b"), (4, "c")]
    hashes = {hash_of(trace_of(order).content()) for order in (poses, poses[::-1])}
    assert len(hashes) == 1


def test_any_other_bit_gives_another_hash():
    other = [trace_of([(2, "a")]), trace_of([(2, "b")]), trace_of([(3, "a")]), trace_of([(2, "a")], marks=())]
    assert len({hash_of(trace.content()) for trace in other}) == 4


def long_trace(**how):
    """Missions for an hour, each with a goal and an outcome, in the order in which the messages come."""
    trace = Trace(**how)
    for second in range(3600):
        for topic in ("/truth", "/estimate"):
            trace.add(TraceEntry(second * SECOND, topic, "/node", f"at {second}"))
        if second % 20 == 3:
            trace.start(second * SECOND)
        if second % 20 == 17:
            outcome = TraceEntry(second * SECOND, "/result", "/move_base", "3 'reached'")
            trace.add(outcome)
            trace.end(outcome)
    trace.add_unstamped("marker shown")
    return trace


def test_spilled_entries_of_a_long_run_are_written():
    trace = long_trace(max_in_memory=100)
    assert len(trace._entries) <= 100 and len(trace._outcomes) <= 5
    whole = long_trace(max_in_memory=1_000_000)
    assert len(whole._entries) > 7000
    assert trace.content() == whole.content()
    assert trace.content() == whole.content(), "a second time"


def test_entries_before_the_first_goal_are_dropped():
    trace = Trace(max_in_memory=100)
    for second in range(1000):
        trace.add(TraceEntry(second * SECOND, "/truth", "/node", "stands"))
    assert len(trace._entries) <= 100
    assert trace.content() == b""


def test_a_long_run_that_cannot_spill_has_no_trace(monkeypatch):
    def full_disk(*_arguments, **_named):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(tempfile, "TemporaryFile", full_disk)
    trace = long_trace(max_in_memory=100)
    assert len(trace._entries) == 0
    with pytest.raises(FileWriteError, match="No space left on device"):
        trace.content()


def test_a_run_without_goals_has_no_trace():
    assert Trace().content() == b""


def test_a_written_trace_is_read_back(tmp_path):
    trace = trace_of([(2, "a"), (3, "b")])
    write_trace(tmp_path, trace.content())
    assert read_trace(tmp_path) == trace.lines()


def test_two_traces_differ_at_the_first_entry_that_only_one_has():
    assert first_difference(["a", "b"], ["a", "b"]) is None
    assert first_difference(["a", "b"], ["a", "c"]) == TraceDifference("b", "c")
    assert first_difference(["a"], ["a", "c"]) == TraceDifference(None, "c")


def test_a_folder_without_a_trace_is_refused(tmp_path):
    with pytest.raises(SettingsError, match=r"trace\.txt: No such file"):
        read_trace(tmp_path)


@pytest.mark.parametrize("line_break", ["\n", "\r", "\u2028"])
def test_a_line_break_in_a_name_does_not_end_a_line(line_break, tmp_path):
    hashes = set()
    for max_in_memory in (5, 1000):
        trace = Trace(max_in_memory)
        trace.start(2 * SECOND)
        for second in range(2, 60):
            trace.add(TraceEntry(second * SECOND, "/state", "/pick_objects", f"post{line_break}card: 1"))
        trace.end(TraceEntry(60 * SECOND, "/state", "/pick_objects", f"post{line_break}card: 5"))
        trace.add_unstamped("marker cup" + line_break)
        write_trace(tmp_path, trace.content())
        assert len(read_trace(tmp_path)) == 60
        hashes.add(hash_of(trace.content()))
    assert len(hashes) == 1
