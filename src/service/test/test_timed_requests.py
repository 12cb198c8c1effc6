"""Requests that are submitted at given times."""

import pytest
from service_bench import site

from evaluation.event_stream import EventStream
from evaluation.events import ServiceUpdated, StateUpdated, TruthUpdated
from planar import Pose2, SettingsError
from service.day.day_recorder import DayRecorder
from service.errors import RequestError
from service.journal import Journal
from service.request_service import RequestService
from service.requests.timed_requests import RequestFeed, TimedRequest, load_requests, save_requests


def test_requests_are_submitted_when_their_time_comes():
    submitted, refused = [], []

    def submit(document, now):
        if document["text"] == "nonsense":
            raise RequestError(["text: no"])
        submitted.append((now, document["text"]))

    requests = [
        TimedRequest(stamp, {"text": text}) for stamp, text in ((9.0, "c"), (2.0, "a"), (3.0, "nonsense"))
    ]
    feed = RequestFeed(requests, submit, refused.append)
    stamps = []
    for now in (1.0, 4.0, 20.0):
        stamps.append(feed.next_stamp)
        feed.advance(now)
    assert submitted == [(4.0, "a"), (20.0, "c")] and refused == ["text: no"]
    assert stamps == [2.0, 2.0, 9.0] and feed.next_stamp == float("inf")


def test_a_file_gives_back_what_was_written_with_ids(tmp_path):
    requests = [TimedRequest(1.5, {"text": "go desk"}), TimedRequest(2.0, {"text": "dock", "id": "night"})]
    first, second = load_requests(save_requests(tmp_path / "r.json", requests))
    assert (first.stamp, first.document["text"], second) == (1.5, "go desk", requests[1])
    assert first.document["id"].startswith("requests-") and first.document["id"].endswith("-1")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("{", "is not valid JSON"),
        ("{}", "expected a list of requests, got dict"),
        ("[1]", "request 1: expected a table of keys and values, got int"),
        ('[{"text": "dock"}]', "request 1: unix_millis_request_time must be when it is sent"),
        ('[{"unix_millis_request_time": NaN}]', "request 1: unix_millis_request_time must be"),
    ],
)
def test_what_is_wrong_with_a_file_is_named(tmp_path, text, problem):
    path = tmp_path / "requests.json"
    path.write_text(text)
    with pytest.raises(SettingsError, match=problem):
        load_requests(path)
    with pytest.raises(SettingsError, match="cannot be read"):
        load_requests(tmp_path / "none.json")


def test_a_day_over_ros_is_recorded_from_events_and_the_journal(tmp_path):
    journal = Journal(tmp_path / "journal.db")
    service = RequestService(site())
    service.submit({"text": "go desk", "id": "one"}, 1000.0)
    journal.store(service.take_changes(), 2)
    journal.close()
    recorder, events = DayRecorder(1000.0, 1101.0), EventStream(on_error=pytest.fail)
    recorder.attach(events)
    events.publish(StateUpdated(0.0, "charging"))
    for stamp in (0.5, 0.6, 1.5, 100.0):
        events.publish(TruthUpdated(stamp, Pose2(stamp, 0.0)))
    events.publish(ServiceUpdated(100.5, 0.25))
    for stamp in (101.0, 101.5):
        events.publish(TruthUpdated(stamp, Pose2(2.0, 0.0)))
    events.publish(StateUpdated(101.5, "driving"))
    sent = (("one", 1000.0), ("two", 1050.0), ("later", 2000.0))
    requests = [TimedRequest(stamp, {"id": name}) for name, stamp in sent]
    record = recorder.record(tmp_path / "journal.db", requests, ["chair", "chair"])
    assert [row[0] for row in record.track] == [1000.5, 1001.5, 1100.0, 1101.0]
    assert record.track[-1][4] == record.lowest_charge == 0.25 and record.empty_at is None
    assert record.idle_seconds == pytest.approx(98.5) and record.end == 1101.0
    assert record.refused == ["two was refused; the log states why"] and record.contacts == ["chair"]
    assert record.activities == [(1000.0, "charging")] and not record.ended
