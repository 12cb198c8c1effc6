"""Traces of runs, and where two of them part."""

import pytest

from home_service.judging.trace import (
    Difference,
    Entry,
    Trace,
    first_difference,
    hash_of,
    read_trace,
    write_trace,
)
from planar import SettingsError

SECOND = 1_000_000_000


def trace_of(poses, end=10, marks=("marker shown",)):
    trace = Trace()
    for stamp, text in poses:
        trace.note(Entry(stamp * SECOND, "/truth", "/sim_bridge", text))
    trace.begin(2 * SECOND)
    trace.end(Entry(end * SECOND, "/state", "/pick_objects", "delivered"))
    for mark in marks:
        trace.mark(mark)
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


def test_a_run_without_goals_has_no_trace():
    assert Trace().content() == b""


def test_what_is_written_is_what_is_read(tmp_path):
    trace = trace_of([(2, "a"), (3, "b")])
    write_trace(tmp_path, trace.content())
    assert read_trace(tmp_path) == trace.lines()


def test_two_traces_part_at_the_first_entry_that_only_one_has():
    assert first_difference(["a", "b"], ["a", "b"]) is None
    assert first_difference(["a", "b"], ["a", "c"]) == Difference("b", "c")
    assert first_difference(["a"], ["a", "c"]) == Difference(None, "c")


def test_a_folder_without_a_trace_is_refused(tmp_path):
    with pytest.raises(SettingsError, match=r"trace\.txt: No such file"):
        read_trace(tmp_path)
