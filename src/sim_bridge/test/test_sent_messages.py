"""Which messages may have a node work whose rest the simulation waits for."""

from sim_bridge.rest.sent_messages import TICKS, are_any_woken, sent_counts

KEPT = {"/amcl": frozenset({"/tf"}), "/watcher": frozenset()}
NODES = {"/amcl": True, "/watcher": False}


def woken_by(receiver, topic, with_all=False):
    """Whether one further message has to be waited for."""
    before = sent_counts([(receiver, topic, 4), ("/amcl", "/scan", 2)], KEPT)
    sent = sent_counts([(receiver, topic, 5), ("/amcl", "/scan", 2)], KEPT)
    assert not are_any_woken(sent, sent, NODES, with_all=True), "nothing was sent"
    return are_any_woken(sent, before, NODES, with_all)


def test_a_message_that_a_node_works_on_is_waited_for():
    assert woken_by("/amcl", "/initialpose")


def test_a_message_that_a_node_keeps_is_waited_for_with_the_clock_or_readings_only():
    assert not woken_by("/amcl", "/tf")
    assert woken_by("/amcl", "/tf", with_all=True)


def test_a_message_to_a_node_that_nobody_listens_to_is_waited_for_with_the_clock_only():
    assert not woken_by("/watcher", "/scan")
    assert woken_by("/watcher", "/scan", with_all=True)


def test_a_topic_is_kept_by_the_node_of_the_rule_only():
    counts = sent_counts([("/amcl", "/tf", 3), ("/amcl", "/scan", 2), ("/watcher", "/tf", 1)], KEPT)
    assert counts == {("/amcl", True): 3, ("/amcl", False): 2, ("/watcher", False): 1}


def test_a_tick_may_have_any_node_work():
    assert woken_by(TICKS, "/simulation/moment")


def test_a_message_to_a_node_that_is_not_waited_for_does_not_matter():
    assert not woken_by("/rviz", "/scan", with_all=True)
