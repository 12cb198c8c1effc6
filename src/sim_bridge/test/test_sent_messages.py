"""Which messages may have a node work whose rest the simulation waits for."""

import pytest

from sim_bridge.rest.sent_messages import TICKS, SentMessages, acting_nodes, sent_counts

KEPT = {"/amcl": frozenset({"/tf"}), "/watcher": frozenset()}
NODES = frozenset(("/amcl", "/watcher"))


def woken_by(receiver, topic, with_all=False, is_clock_next=False, acting=("/amcl",)):
    """Whether one further message has to be waited for."""
    messages = SentMessages()
    messages.acting = frozenset(acting)
    before = sent_counts([(receiver, topic, 4), ("/amcl", "/scan", 2)], KEPT)
    sent = sent_counts([(receiver, topic, 5), ("/amcl", "/scan", 2)], KEPT)
    messages.await_rest(before)
    messages.note_rest()
    assert not messages.wake_any(before, NODES, is_clock_next, with_all=True), "nothing was sent"
    return messages.wake_any(sent, NODES, is_clock_next, with_all)


def test_a_message_that_a_node_works_on_is_waited_for():
    assert woken_by("/amcl", "/initialpose")


def test_a_message_that_a_node_keeps_is_waited_for_with_the_clock_or_readings_only():
    assert not woken_by("/amcl", "/tf")
    assert woken_by("/amcl", "/tf", with_all=True)


def test_a_message_to_a_node_that_does_not_act_is_waited_for_with_the_clock_only():
    assert not woken_by("/watcher", "/scan")
    assert woken_by("/watcher", "/scan", with_all=True)


def test_a_topic_is_kept_by_the_node_of_the_rule_only():
    counts = sent_counts([("/amcl", "/tf", 3), ("/amcl", "/scan", 2), ("/watcher", "/tf", 1)], KEPT)
    assert counts == {("/amcl", True): 3, ("/amcl", False): 2, ("/watcher", False): 1}


def test_a_tick_may_have_any_node_work_that_acts_and_any_other_before_the_clock():
    assert woken_by(TICKS, "/simulation/moment")
    assert not woken_by(TICKS, "/simulation/moment", with_all=True, acting=())
    assert woken_by(TICKS, "/simulation/moment", is_clock_next=True, acting=())


def test_a_message_to_a_node_that_is_not_waited_for_does_not_matter():
    assert not woken_by("/rviz", "/scan", with_all=True)


def test_a_clock_that_nobody_waits_for_is_no_reason_to_wait_later_but_a_tick_is():
    messages = SentMessages()
    sent = sent_counts([("/watcher", "/clock", 1), (TICKS, "/simulation/moment", 1)], KEPT)
    messages.note_idle(sent)
    assert messages.wake_any(sent, NODES, is_clock_next=True, with_all=True)
    messages.await_rest(sent)
    messages.note_rest()
    assert not messages.wake_any(sent, NODES, is_clock_next=True, with_all=True)


@pytest.mark.parametrize(
    ("receivers", "callers", "acting"),
    [
        ({"/pick": {"/move_base"}, "/move_base": {"/sim"}}, (), set()),
        ({"/amcl": {"/planner"}, "/planner": {"/sim", "/amcl"}, "/view": set()}, (), {"/amcl", "/planner"}),
        ({"/pick": {"/spawner"}, "/spawner": set(), "/view": set()}, ("/spawner",), {"/pick", "/spawner"}),
        ({"/pick": {"/mark"}, "/mark": {"/pick"}}, ("/rosservice",), set()),
    ],
)
def test_nodes_act_between_ticks_whose_messages_or_calls_reach_the_simulator(receivers, callers, acting):
    """Those that reach it through a synchronised node, here move_base, have to wait for its tick."""
    assert acting_nodes(receivers, {"/sim", *callers}, {"/move_base"}) == acting
