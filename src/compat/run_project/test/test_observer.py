"""The observer notices that the graph changes, and that a new node may send goals."""

from types import SimpleNamespace

from run_project.ros import observer
from run_project.ros.graph_nodes import GraphNodes
from run_project.ros.observer import CLIENT_SECONDS, Observer

GOALS = "/move_base/goal"


def test_a_changed_graph_and_a_new_client_are_noticed(monkeypatch):
    published = []
    master = SimpleNamespace(
        getSystemState=lambda: [list(published), [], []],
        getTopicTypes=lambda: [[GOALS, "move_base_msgs/MoveBaseActionGoal"]],
    )
    monkeypatch.setattr(observer.rosgraph, "Master", lambda caller: master)
    seen = Observer(print)
    seen.nodes = GraphNodes(lambda name: None)
    monkeypatch.setattr(seen, "_subscribe", lambda topic, like: None)

    def is_new_with(publishers, now):
        published[:] = publishers
        seen.discover_topics(now)
        return seen.is_graph_new

    scans = [["/scan", ["/gazebo"]]]
    assert is_new_with(scans, 0.0)
    assert not is_new_with(scans, 1.0)
    assert not is_new_with([*scans, ["/clicked_point", ["/rviz"]]], 2.0), "rviz only receives"
    assert not is_new_with([*scans, ["/rosout", ["/cockpit_7"]]], 2.5), "so does the cockpit"
    assert not seen.goal_clients
    with_client = [*scans, [GOALS, ["/pick_objects", "/move_base"]]]
    assert is_new_with(with_client, 3.0)
    assert seen.goal_clients == {"/pick_objects"}
    assert is_new_with(with_client, 3.0 + 0.9 * CLIENT_SECONDS)
    assert not is_new_with(with_client, 3.0 + 1.1 * CLIENT_SECONDS)
