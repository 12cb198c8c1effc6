"""End of a run whose files cannot be written."""

import json
import threading

import pytest

from evaluation import trace
from evaluation.event_stream import EventStream
from evaluation.events import SUCCEEDED, GoalAccepted, GoalEnded, Publication, TruthUpdated
from evaluation.options import GraphOptions
from evaluation.ros import run as run_module
from evaluation.ros.run import Run
from evaluation.verdict import Verdict
from planar import FileWriteError, Pose2
from run_report import RunRecord
from supervision import run_folder
from supervision.errors import ResultError

DONE = Verdict(True, "picked up and delivered")


class Display:
    """Keeps what is printed."""

    def __init__(self):
        self.printed = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def print(self, line):
        self.printed.append(line)

    def show(self, status):
        pass


class Graph:
    """In the place of the supervisor: whether it was ended."""

    log_gap = None
    restarts = ()
    is_ended = False
    has_pending_work = False

    def end(self):
        self.is_ended = True


class Watch:
    """In the place of judge and recorder."""

    def result_fields(self):
        return {}

    def record(self):
        return RunRecord()


@pytest.fixture
def run(tmp_path, monkeypatch):
    """One that is brought up without a graph, and has driven."""
    monkeypatch.setattr(run_module, "Supervisor", lambda *_: Graph())
    monkeypatch.setattr(run_module.rospy, "signal_shutdown", lambda reason: None)
    monkeypatch.setattr(run_module, "raise_when_interrupted", lambda: None)
    monkeypatch.setattr(run_module, "ignore_write_errors", lambda: None)
    monkeypatch.setattr(Run, "_bring_up", lambda self: None)
    options = GraphOptions(output=tmp_path)
    made = Run(options, options.launch("home.launch"), Watch(), Watch(), Display())
    made.events = EventStream()
    made._trace.attach(made.events)
    made.events.publish(GoalAccepted(0.0, Pose2(), published(0.0, "/goal")))
    made.events.publish(outcome(1.0, "a"))
    monkeypatch.setattr(run_module, "SETTLE_SECONDS", 0.0)
    return made


def published(stamp, topic):
    return Publication(round(stamp * 1e9), topic, "/a_node")


def outcome(stamp, identity):
    return GoalEnded(stamp, identity, SUCCEEDED, identity, published(stamp, "/result"))


def full_disk(path, data):
    raise FileWriteError(f"{path}: cannot be written (No space left on device)")


def test_a_trace_that_cannot_be_written_is_only_listed_as_missing(run, monkeypatch):
    monkeypatch.setattr(trace, "write_atomically", full_disk)
    with run:
        assert run.conclude(DONE) == 0
    result = json.loads((run.folder / "result.json").read_text())
    assert result["success"] and result["hash"]
    assert result["missing"] == ["trace.txt: cannot be written (No space left on device)"]
    assert run._supervisor.is_ended


def test_a_run_that_cannot_write_its_result_has_failed(run, monkeypatch):
    monkeypatch.setattr(run_folder, "write_atomically", full_disk)
    with run:
        assert run.conclude(DONE) == 1
    verdict = "FAILURE: result.json: cannot be written (No space left on device); what the run came to: "
    assert f"{verdict}{DONE.reason}" in run.display.printed
    assert run._supervisor.is_ended
    assert not (run.folder / "result.json").exists()


def test_a_disk_that_becomes_full_at_the_end_turns_a_success_into_an_error(run, monkeypatch):
    with pytest.raises(
        ResultError, match=r"result\.json: cannot be written \(No space left on device\)"
    ), run:
        assert run.conclude(DONE) == 0
        monkeypatch.setattr(run_folder, "write_atomically", full_disk)
    assert run._supervisor.is_ended
    assert not (run.folder / "result.json").exists()


def test_a_failed_run_without_a_result_raises_no_second_error(run, monkeypatch):
    monkeypatch.setattr(run_folder, "write_atomically", full_disk)
    with pytest.raises(RuntimeError, match="a fault of ours"), run:
        raise RuntimeError("a fault of ours")
    assert run._supervisor.is_ended


def test_rospy_is_not_waited_for_while_it_waits_for_a_master_that_is_gone(run, monkeypatch):
    reasons = []
    monkeypatch.setattr(run_module.rospy, "signal_shutdown", reasons.append)
    run._supervisor.has_pending_work = True
    with run:
        run.conclude(DONE)
    assert reasons == []
    assert run._supervisor.is_ended


def test_the_graph_is_ended_whatever_goes_wrong_before(run, monkeypatch):
    def broken(_self, _error):
        raise OSError("a view that cannot be closed")

    monkeypatch.setattr(Run, "_finish", broken)
    with pytest.raises(OSError, match="a view"), run:
        pass
    assert run._supervisor.is_ended


def test_the_trace_has_an_outcome_that_is_in_flight_at_the_end(run, monkeypatch):
    """As on a busy machine, where the thread of one topic is later than that of another."""
    monkeypatch.setattr(run_module, "SETTLE_SECONDS", 10.0)

    def publish_late():
        run.events.publish(outcome(0.9, "late"))
        run.events.publish(TruthUpdated(1.4, Pose2(), publication=published(1.4, "/truth")))

    late = threading.Timer(0.2, publish_late)
    late.start()
    with run:
        assert run.conclude(DONE) == 0
    late.join()
    lines = (run.folder / "trace.txt").read_text().splitlines()
    assert [line.split()[-1] for line in lines] == ["1.0", "'late'", "'a'"]


def test_messages_in_flight_are_not_waited_for_if_time_stands_still(run, monkeypatch):
    monkeypatch.setattr(run_module, "SETTLE_SECONDS", 0.05)
    with run:
        assert run.conclude(DONE) == 0
    assert (run.folder / "trace.txt").exists()


def test_messages_that_have_arrived_are_part_of_the_trace(run, monkeypatch):
    """A thread that is behind that of the ground truth processes one when the trace has settled."""
    looks = iter((True, True, False))

    def has_unprocessed():
        run.events.publish(TruthUpdated(0.5, Pose2(), publication=published(0.5, "/late")))
        return next(looks)

    monkeypatch.setattr(run_module, "has_unprocessed", has_unprocessed)
    with run:
        assert run.conclude(DONE) == 0
    assert next(looks, "all were made") == "all were made"
    assert "/late" in (run.folder / "trace.txt").read_text()


def test_an_end_that_cannot_be_awaited_is_named(run, monkeypatch):
    monkeypatch.setattr(run_module, "PROCESSING_SECONDS", 0.05)
    monkeypatch.setattr(run_module, "has_unprocessed", lambda: True)
    with run:
        assert run.conclude(DONE) == 0
    assert "end of the trace: not processed within 0.05 s" in "".join(run.display.printed)
