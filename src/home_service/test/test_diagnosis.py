import json

import pytest

from home_service.doctor.diagnosis import (
    GraphSnapshot,
    NodeState,
    TopicState,
    as_json,
    as_text,
    frame_branches,
    frame_chain,
    problems,
)


def healthy_graph():
    return GraphSnapshot(
        master="http://127.0.0.1:11311",
        nodes=[NodeState("/amcl"), NodeState("/sim_bridge")],
        topics=[
            TopicState("/clock", ["/sim_bridge"], ["/amcl"], 50.0),
            TopicState("/scan", ["/sim_bridge"], ["/amcl"], 10.0),
            TopicState("/initialpose", [], ["/amcl"]),
        ],
        parents={"odom": {"map"}, "base_link": {"odom"}, "laser": {"base_link"}, "wheel": {"base_link"}},
        uses_simulated_time=True,
        real_time_factor=4.0,
        versions={"python": "3.11"},
    )


def test_a_graph_in_which_all_is_well_has_no_problem():
    assert problems(healthy_graph()) == []
    assert as_json(healthy_graph())["healthy"]


def test_without_a_graph_there_are_no_problems_and_it_is_not_healthy():
    assert problems(GraphSnapshot()) == []
    assert not as_json(GraphSnapshot())["healthy"]
    assert "nothing is running" in as_text(GraphSnapshot())[-1]


def without_clock(graph):
    graph.topics[0].publishers.clear()


def paused(graph):
    graph.real_time_factor = 0.0


def by_wall_clock(graph):
    graph.uses_simulated_time = False


def dead(graph):
    graph.nodes[0].is_alive = False


def waiting(graph):
    graph.nodes[0].waits_for.append("a map on /map")


def without_scan(graph):
    graph.topics[1].publishers.clear()


def silent_scan(graph):
    graph.topics[1].rate = 0.0


def two_parents(graph):
    graph.parents["base_link"].add("base_footprint")


@pytest.mark.parametrize(
    "harm, sentence",
    [
        (without_clock, "nobody publishes /clock"),
        (paused, "/clock stands still"),
        (by_wall_clock, "use_sim_time is not true"),
        (dead, "/amcl is registered but does not answer"),
        (waiting, "/amcl waits for a map on /map"),
        (without_scan, "no node publishes /scan, to which /amcl subscribes"),
        (silent_scan, "no messages on /scan from /sim_bridge"),
        (two_parents, "frame base_link has several parents: base_footprint, odom"),
        (two_parents, "2 trees, with the roots base_footprint, map"),
    ],
)
def test_each_problem_is_reported(harm, sentence):
    graph = healthy_graph()
    harm(graph)
    assert any(sentence in problem for problem in problems(graph)), problems(graph)
    assert any(sentence in line for line in as_text(graph))


def test_frame_chains_end_even_in_a_cycle():
    parents = healthy_graph().parents
    assert frame_chain(parents, "laser") == ["map", "odom", "base_link", "laser"]
    assert frame_branches(parents) == ["map -> odom -> base_link -> laser, wheel"]
    assert len(frame_chain({"a": {"b"}, "b": {"a"}}, "a")) <= 4


def test_a_snapshot_can_be_written_as_json():
    assert json.loads(json.dumps(as_json(healthy_graph())))["parents"]["odom"] == ["map"]
