"""Validation of requests."""

import json
from datetime import timezone

import pytest
from service_bench import NOW, PLACES

from service.errors import RequestError
from service.requests.calendar_times import next_repetition, parse_duration, parse_time
from service.requests.parser import Knowledge, parse_request
from service.requests.request import (
    Deliver,
    Fetch,
    Go,
    GoToDock,
    Patrol,
    Wait,
    request_from_json,
    request_to_json,
)

KNOWN = Knowledge(tuple(PLACES), True, timezone.utc)
MINUTE = 60_000
MILLIS = round(1000 * NOW)


def parsed(**document):
    return parse_request(document, KNOWN, NOW)


def problems(document):
    with pytest.raises(RequestError) as error:
        parse_request(document, KNOWN, NOW)
    return str(error.value)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("deliver cup from kitchen to desk", Deliver("cup", "kitchen", "desk")),
        ("fetch cup to desk", Fetch("cup", "desk")),
        ("go to hall", Go("hall")),
        ("go hall", Go("hall")),
        ("patrol kitchen, desk and hall 3 times", Patrol(("kitchen", "desk", "hall"), 3)),
        ("patrol kitchen desk", Patrol(("kitchen", "desk"))),
        ("wait 5min at hall", Wait(300.0, "hall")),
        ("wait 90", Wait(90.0)),
        ("Dock", GoToDock()),
    ],
)
def test_a_line_of_text_is_a_request(text, expected):
    request = parsed(text=text)
    assert request.description == expected
    assert request_from_json(json.loads(json.dumps(request_to_json(request)))) == request


def test_a_task_request_of_open_rmf_is_accepted():
    request = parsed(
        category="deliver",
        description={"object": "cup", "from": "kitchen", "to": "desk"},
        priority={"type": "binary", "value": 1},
        requester="anna",
        labels=["app=dashboard"],
        unix_millis_request_time=MILLIS,
        unix_millis_earliest_start_time=MILLIS + MINUTE,
        unix_millis_deadline=MILLIS + 10 * MINUTE,
    )
    assert (request.priority, request.requester, request.labels) == (1, "anna", ("app=dashboard",))
    assert (request.earliest_start, request.deadline) == (NOW + 60.0, NOW + 600.0)
    assert request_from_json(request_to_json(request)) == request


def test_times_may_be_written_as_people_do():
    assert parsed(text="go hall", by="09:30").deadline == NOW + 5400.0
    assert parsed(text="go hall", by="+30min").deadline == NOW + 1800.0
    assert parsed(text="go hall", not_before="07:00").earliest_start == NOW + 23 * 3600.0, "tomorrow"
    assert parsed(text="go hall", by="2026-11-30T08:30").deadline == NOW + 1800.0
    assert parse_time("2026-11-30T09:30+01:00", NOW) == NOW + 1800.0
    assert [parse_duration(text) for text in ("5", "5 min", "1.5h", "1d")] == [5.0, 300.0, 5400.0, 86400.0]


def test_a_repetition_starts_at_its_first_time():
    assert parsed(text="go hall", repeat="30 8 * * *").earliest_start == NOW + 1800.0
    assert next_repetition("0 8 * * 1", NOW, timezone.utc) == NOW + 7 * 86400.0


@pytest.mark.parametrize(
    ("document", "expected"),
    [
        ({"text": "deliver cup from kitchn to desk"}, 'there is no place "kitchn" (did you mean "kitchen"?)'),
        ({"text": "deliver cup from desk to desk"}, "expected another place than desk"),
        ({"text": "deliver cup to desk"}, "expected: deliver OBJECT from PLACE to PLACE"),
        ({"text": "delver cup from kitchen to desk"}, 'did you mean "deliver"?'),
        ({"text": ""}, "is no request"),
        ({}, "category: is missing (known: deliver"),
        ({"category": 7}, "category"),
        ({"category": "go"}, "description: place is missing"),
        ({"category": "go", "description": {"plce": "hall"}}, 'did you mean "place"?'),
        ({"category": "go", "description": []}, "expected a table"),
        ({"category": "wait", "description": {"seconds": float("nan")}}, "expected a number from 0 to 86400"),
        ({"category": "wait", "description": {"seconds": True}}, "expected a number"),
        ({"category": "patrol", "description": {"places": ["hall"] * 1001}}, "list of 1 to 1000"),
        (
            {"category": "patrol", "description": {"places": ["hall"] * 100, "rounds": 99}},
            "at most 1000 places",
        ),
        ({"text": "go hall", "priority": 10}, "priority: expected a whole number from 0 to 9"),
        ({"text": "go hall", "priority": {"type": "level"}}, "priority"),
        ({"text": "go hall", "labels": "urgent"}, "labels"),
        ({"text": "go hall", "requester": "x" * 300}, "requester: expected a text of at most 200"),
        ({"text": "go hall", "prioritty": 1}, 'unknown key "prioritty" (did you mean "priority"?)'),
        ({"text": "go hall", "unix_millis_deadline": MILLIS - MINUTE}, "07:59:00 has passed; it is"),
        ({"text": "go hall", "unix_millis_deadline": round(NOW)}, "expected Unix milliseconds"),
        ({"text": "go hall", "unix_millis_deadline": 1e300}, "expected Unix milliseconds"),
        ({"text": "go hall", "by": "noon"}, "'noon' is no time; expected 18:00"),
        ({"text": "go hall", "by": "08:05", "not_before": "08:10"}, "before the earliest start"),
        ({"text": "go hall", "by": "08:05", "unix_millis_deadline": MILLIS}, "either by or"),
        ({"text": "go hall", "repeat": "every day"}, "expected five fields"),
        ({"text": "go hall", "repeat": "61 8 * * *"}, "repeat"),
        ({"text": "go hall", "category": "go"}, "either text, or category"),
        ("go hall", "not str"),
        (None, "not NoneType"),
    ],
)
def test_invalid_requests_are_answered_with_the_reason(document, expected):
    assert expected in problems(document)


def test_all_problems_are_reported_at_once():
    text = problems({"text": "deliver cup from cellar to attic", "priority": "high", "labels": 1})
    assert [word in text for word in ("cellar", "attic", "priority", "labels")] == [True] * 4


def test_docking_needs_a_dock():
    with pytest.raises(RequestError, match="there is no dock"):
        parse_request({"text": "dock"}, Knowledge(tuple(PLACES)), NOW)
