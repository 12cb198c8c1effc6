"""Requests for objects whose place is not known: find, and bring to a place."""

from dataclasses import replace

import numpy as np
import pytest
from service_bench import NOW, PLACES, Bench, ideal_robot, site

from pick_objects import LookForObject, LookTaken, SearchArea
from planar import OccupancyGrid, Pose2
from planar.maps.semantic_map import FurnitureTop, ObjectPrior, SemanticMap
from service.errors import RequestError
from service.requests.mission_requests import documents_of
from service.requests.parser import Knowledge, parse_request
from service.requests.request import (
    DESCRIPTIONS,
    Deliver,
    Fetch,
    Find,
    Go,
    GoToDock,
    Patrol,
    Wait,
)
from service.requests.text import parse_text
from service.task import TaskStatus

GRID = OccupancyGrid(np.zeros((100, 100), dtype=np.int8), 0.1, Pose2(-1.0, -1.0))
TABLES = {
    name: FurnitureTop(name, "table", "", Pose2(x, 4.0), (1.0, 0.8), 0.7)
    for name, x in (("dresser", 2.0), ("counter", 7.0))
}
MAP = SemanticMap({}, TABLES, {"cup": ObjectPrior("cup", {"table": 1.0})})


class SeeingRobot:
    """A robot without physics that detects a cup from within 2.5 m."""

    def __init__(self, cup_at):
        self._robot, self._cup_at, self._looks = ideal_robot(), cup_at, False

    def inputs(self, now):
        return self._robot.inputs(now)

    def event(self, now):
        if not self._looks:
            return self._robot.event(now)
        self._looks, base = False, self._robot.pose
        is_near = self._cup_at is not None and base.distance_to(Pose2(*self._cup_at)) < 2.5
        return LookTaken(base, self._cup_at if is_near else None)

    def carry_out(self, order, now):
        self._looks = isinstance(order, LookForObject)
        if not self._looks:
            self._robot.carry_out(order, now)


def bench(cup_at, semantic_map=MAP):
    known = Knowledge(tuple(PLACES), True, semantic_map=semantic_map)
    where = replace(site(), known=known, area=SearchArea(GRID, MAP))
    return Bench(robot=SeeingRobot(cup_at), where=where)


def test_an_object_is_found():
    one = bench((7.0, 4.0))
    (task,) = one.finish(one.send("find cup"))
    assert task.status is TaskStatus.COMPLETED
    assert one.service.book.objects["cup"].place == "counter"
    assert "cup is on counter, at (7.00, 4.00)" in [entry.text for entry in one.log]


def test_an_object_is_searched_and_brought():
    one = bench((2.0, 4.0))
    (task,) = one.finish(one.send("bring cup to desk"))
    assert task.status is TaskStatus.COMPLETED
    assert one.service.book.objects["cup"].place == "desk"


def test_what_was_found_is_fetched_without_another_search():
    one = bench((2.0, 4.0))
    one.finish(one.send("find cup"))
    looks = sum(isinstance(order, LookForObject) for order in one.orders)
    one.finish(one.send("bring cup to hall"), one.send("find cup"))
    assert sum(isinstance(order, LookForObject) for order in one.orders) == looks
    assert one.service.book.objects["cup"].place == "hall"


def test_an_object_that_is_nowhere_ends_the_task_with_what_was_looked_at():
    one = bench(None)
    (task,) = one.finish(one.send("bring cup to desk"))
    assert task.status is TaskStatus.FAILED
    assert "cup was not found in" in task.reason and "dresser" in task.reason and "counter" in task.reason


def test_a_search_is_interrupted_by_a_more_urgent_request_and_resumed():
    one = bench((7.0, 4.0))
    search = one.send("find cup")
    one.run_until(lambda: any(isinstance(order, LookForObject) for order in one.orders))
    ended = one.finish(one.send("go hall", priority=9), search)
    assert [task.status for task in ended] == [TaskStatus.COMPLETED, TaskStatus.COMPLETED]


@pytest.mark.parametrize(
    ("semantic_map", "text", "message"),
    [
        (MAP, "find cupp", 'objects do not list cupp .did you mean "cup"'),
        (MAP, "bring anchor to desk", "objects do not list anchor .known: cup"),
        (None, "find cup", "no semantic map to search it by"),
        (replace(MAP, furniture={}), "find cup", "has no furniture"),
    ],
)
def test_what_cannot_be_searched_is_refused(semantic_map, text, message):
    with pytest.raises(RequestError, match=message):
        bench(None, semantic_map).send(text)


def test_the_forms_of_searches():
    assert parse_text("find cup") == {"category": "find", "description": {"object": "cup"}}
    bring = {"category": "fetch", "description": {"object": "cup", "to": "living room"}}
    assert parse_text("bring cup to living room") == bring


KINDS = [
    Deliver("cup", "kitchen", "desk"),
    Fetch("cup", "desk"),
    Find("cup"),
    Go("desk"),
    Patrol(("desk", "kitchen"), 2),
    Wait(90.0, "desk"),
    GoToDock(),
]


@pytest.mark.parametrize("description", KINDS)
def test_the_text_of_a_request_is_a_request_again(description):
    known = Knowledge(tuple(PLACES), has_dock=True, semantic_map=MAP)
    document = {**parse_text(description.text), "priority": 0}
    assert parse_request(document, known, NOW).description == description


def test_all_kinds_of_requests_have_a_text():
    assert {type(each) for each in KINDS} == set(DESCRIPTIONS.values())


def test_missions_with_searches_are_requests():
    from pick_objects import parse_mission

    text = "deliveries: [{find: cup}, {object: cup, to: desk}]"
    one = bench((2.0, 4.0))
    documents = documents_of(parse_mission(text, PLACES), "m")
    tasks = [one.service.submit(document, NOW) for document in documents]
    assert [type(task.request.description) for task in tasks] == [Find, Fetch]
    assert {task.status for task in one.finish(*tasks)} == {TaskStatus.COMPLETED}
