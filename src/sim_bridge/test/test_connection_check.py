"""Questions about the graph to a master from which nodes have gone meanwhile."""

import threading
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from sim_bridge.ros.timing import connection_check
from sim_bridge.ros.timing.connection_check import ConnectionCheck


@pytest.fixture
def check(monkeypatch):
    """A check of a master that lists a node, and no longer knows it when it is asked for it."""
    master = SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
    master.register_function(lambda caller, name: [-1, f"unknown node [{name}]", ""], "lookupNode")
    state = [[["/scan", ["/gone"]]], [["/scan", ["/amcl"]]], []]
    master.register_function(lambda caller: [1, "current system state", state], "getSystemState")
    monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{master.server_address[1]}")
    monkeypatch.setattr(connection_check.rospy, "get_name", lambda: "/sim")
    threading.Thread(target=master.serve_forever, daemon=True).start()
    yield ConnectionCheck()
    master.shutdown()
    master.server_close()


def test_a_node_that_has_gone_has_no_process(check):
    assert check.local_process("/gone") is None


def test_a_node_that_has_gone_is_not_elsewhere(check):
    assert not check.is_elsewhere("/gone")


def test_its_connections_are_asked_for_again(check):
    (missing,) = check.missing({"/gone", "/amcl"}, (), ())
    assert "unknown node [/gone]" in missing
