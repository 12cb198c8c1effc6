"""Service calls of nodes that are not synchronised are noted; those of synchronised nodes wait."""

from types import SimpleNamespace

import pytest

from planar_ros.lockstep.transport import CallMonitor, call_headers, caller, delaying_calls

MEMBERS = frozenset(("/sim_bridge", "/pick_objects"))


@pytest.fixture
def server():
    """What a server does before a call: it waits for the number of its instant, and notes it if it must."""
    seen = SimpleNamespace(waited=[], noted=[], members=MEMBERS)
    monitor = CallMonitor(lambda: seen.members, seen.noted.append, harmless=("/sim_bridge/set_parameters",))
    before_call = delaying_calls(seen.waited.append, monitor)
    seen.monitor = monitor
    seen.call = lambda service, node, **header: before_call(service, {"callerid": node, **header})
    return seen


def test_a_call_of_a_node_that_is_not_synchronised_is_noted(server):
    server.call("/gazebo/reset_simulation", "/rosservice")
    assert server.noted == [
        "the service /gazebo/reset_simulation was called by /rosservice, which is not synchronized"
    ]


def test_a_service_is_noted_once(server):
    for number in range(3):
        server.call("/global_localization", f"/rosservice_{number}")
    assert len(server.noted) == 1


def test_a_call_of_a_synchronised_node_waits_and_is_not_noted(server):
    server.call("/move_base/clear_costmaps", "/pick_objects", **call_headers(7))
    assert caller() == "/pick_objects"
    server.call("/move_base/clear_costmaps", "/pick_objects", **call_headers(0))
    assert caller() == ""
    assert server.waited == [7]
    assert server.noted == []


def test_nodes_are_known_that_call_services_and_are_not_synchronised(server):
    server.call("/gazebo/get_model_state", "/sorter")
    server.call("/gazebo/get_model_state", "/pick_objects")
    server.call("/sim_bridge/set_parameters", "/rqt")
    assert server.monitor.callers == {"/sorter"}


def test_a_call_before_nodes_are_synchronised_is_not_noted(server):
    server.members = frozenset()
    server.call("/gazebo/spawn_sdf_model", "/spawn_model")
    assert server.noted == []


@pytest.mark.parametrize(
    "service",
    [
        "/gazebo/get_physics_properties",
        "/gazebo/pause_physics",
        "/gazebo/unpause_physics",
        "/move_base/make_plan",
        "/move_base/NavfnROS/make_plan",
        "/static_map",
        "/amcl/set_logger_level",
        "/tf2_frames",
        "/sim_bridge/set_parameters",
    ],
)
def test_a_call_that_changes_nothing_in_the_simulation_is_not_noted(server, service):
    server.call(service, "/rqt")
    assert server.noted == []
