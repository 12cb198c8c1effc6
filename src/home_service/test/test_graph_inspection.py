"""Inspection of a graph that changes meanwhile."""

from types import SimpleNamespace

import pytest
import rosgraph

from home_service.doctor.diagnosis import GraphSnapshot, NodeState
from home_service.ros import graph_inspection


class Master:
    """Names two nodes, one of which is gone when it is asked for."""

    def __init__(self, *_):
        pass

    def getSystemState(self):  # noqa: N802
        return [["/scan", ["/gone", "/there"]]], [], []

    def lookupNode(self, name):  # noqa: N802
        if name == "/gone":
            raise rosgraph.MasterError("unknown node [/gone]")
        return "http://127.0.0.1:1/"


@pytest.fixture(autouse=True)
def graph(monkeypatch):
    rospy = SimpleNamespace(
        get_name=lambda: "/doctor",
        get_param=lambda *_: False,
        signal_shutdown=lambda _reason: None,
        FATAL=0,
    )
    monkeypatch.setattr(graph_inspection, "rospy", rospy)
    monkeypatch.setattr(graph_inspection, "init_node", lambda *_, **__: None)
    monkeypatch.setattr(rosgraph, "Master", Master)
    monkeypatch.setattr(graph_inspection, "answers", lambda _uri: True)
    monkeypatch.setattr(graph_inspection.TopicMonitor, "measure", lambda *_: None)
    monkeypatch.setenv("ROS_MASTER_URI", "")


def test_a_node_that_exits_during_the_inspection_is_left_out():
    snapshot = GraphSnapshot()
    graph_inspection._inspect(snapshot, "http://127.0.0.1:2", 0.0)
    assert snapshot.nodes == [NodeState("/there", is_alive=True)]
