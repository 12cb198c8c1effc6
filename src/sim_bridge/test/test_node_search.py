"""Nodes of the graph, who receives from whom, and when others may have to connect."""

import os
import time

import pytest

from sim_bridge.rest.rules import PaceRule
from sim_bridge.ros.timing import node_search
from sim_bridge.ros.timing.node_search import NodeSearch, has_more

SECONDS = 10.0
PUBLISHED = {"/tf": ["/amcl"], "/pose": ["/amcl"], "/view": ["/move_base"], "/rosout": ["/amcl", "/log"]}
SUBSCRIBED = {
    "/tf": ["/move_base", "/sim"],
    "/pose": ["/amcl", "/viewer"],
    "/view": ["/sim"],
    "/rosout": ["/log"],
    "/clock": ["/amcl", "/move_base", "/viewer", "/log"],
}


def table(**entries):
    return {f"/{topic}": nodes.split() for topic, nodes in entries.items()}


@pytest.mark.parametrize(
    ("now", "expected"),
    [
        (table(tf="a b"), False),
        (table(tf="a"), False),
        ({}, False),
        (table(tf="a b c"), True),
        (table(tf="a b", odom="a"), True),
    ],
)
def test_only_what_was_not_there_before_has_to_connect(now, expected):
    before = table(tf="a b")
    assert has_more(({}, now, {}), ({}, before, {})) == expected


class Graph:
    lost = ()

    def graph(self):
        return PUBLISHED, SUBSCRIBED, {}

    def missing(self, members, observers, static_publishers):
        return self.lost

    def local_process(self, name):
        return os.getpid()


@pytest.fixture
def search(monkeypatch):
    ended = []
    monkeypatch.setattr(node_search, "ConnectionCheck", Graph)
    monkeypatch.setattr(node_search.rospy, "get_name", lambda: "/sim")
    monkeypatch.setattr(node_search.rospy, "is_shutdown", lambda: bool(ended))
    found = NodeSearch({"/viewer": PaceRule("observe")}, {}, ("/log",))
    found.start()
    wait_for(found, 1)
    yield found
    ended.append(True)


def wait_for(search, number):
    deadline = time.monotonic() + SECONDS
    while search.finished < number and time.monotonic() < deadline:
        time.sleep(0.01)
    assert search.finished >= number


def test_a_lost_connection_is_found_in_an_unchanged_graph(search, monkeypatch):
    wait_for(search, search.request())
    assert search.unconnected == ()
    monkeypatch.setattr(Graph, "lost", ["/scan from /sim to /amcl"])
    wait_for(search, search.request())
    assert search.unconnected == (), "what was connected is not asked for again"
    search.check_all_connections()
    wait_for(search, search.request())
    assert search.unconnected == ("/scan from /sim to /amcl",)


def test_receivers_are_other_nodes_and_the_simulator_but_no_observers(search):
    assert search.nodes["/amcl"].receivers == {"/move_base", "/sim"}
    assert search.nodes["/move_base"].receivers == {"/sim"}
    assert search.nodes["/viewer"].receivers == set()


def test_bystanders_are_not_searched_for(search):
    assert "/log" not in search.nodes
