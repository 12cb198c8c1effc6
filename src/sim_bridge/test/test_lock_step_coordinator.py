"""The coordinator of lock-step: due ticks, awaited nodes, delivered messages."""

import pytest

from sim_bridge.lock_step import LockStepCoordinator

STEP = 0.02


def coordinator_of(*names, latency=0.1, period=0.1):
    coordinator = LockStepCoordinator(latency)
    for name in names:
        coordinator.add_member(name, period)
    return coordinator


def stamps_of_ticks(coordinator, until):
    """Times at which ticks begin if every node answers at once."""
    found, step = [], 0
    while step * STEP < until:
        begun = coordinator.begin_tick(step * STEP)
        if begun is not None:
            found.append(round(step * STEP, 6))
            for name in coordinator.members:
                coordinator.record_answer(name, begun[0], {})
        step += 1
    return found


def test_without_nodes_there_are_no_ticks():
    assert stamps_of_ticks(coordinator_of(), 1.0) == []


def test_ticks_are_at_multiples_of_the_shortest_period():
    assert stamps_of_ticks(coordinator_of("/amcl"), 0.45) == [0.0, 0.1, 0.2, 0.3, 0.4]
    quick = coordinator_of("/amcl")
    quick.add_member("/move_base", 0.04)
    assert stamps_of_ticks(quick, 0.17) == [0.0, 0.04, 0.08, 0.12, 0.16]


def test_ticks_may_come_a_step_after_the_multiples():
    coordinator = coordinator_of("/pick_objects")
    coordinator.delay = STEP
    assert stamps_of_ticks(coordinator, 0.35) == [0.0, 0.02, 0.12, 0.22, 0.32]


def test_a_node_that_joins_late_gets_a_tick_at_once_with_all_members():
    coordinator = coordinator_of("/amcl")
    assert coordinator.begin_tick(0.0) == (1, True)
    assert coordinator.begin_tick(0.04) is None
    coordinator.add_member("/move_base", 0.1)
    assert coordinator.begin_tick(0.06) == (2, True)
    assert coordinator.begin_tick(0.1) == (3, False)


def test_time_may_pass_until_messages_are_delivered():
    coordinator = coordinator_of("/amcl", "/move_base", latency=0.06)
    coordinator.begin_tick(0.0)
    coordinator.record_answer("/amcl", 1, {"/amcl /move_base /tf": 1})
    assert not coordinator.delivery_due(0.04)
    assert coordinator.delivery_due(0.06)
    assert coordinator.unanswered() == ["/move_base"]
    coordinator.record_answer("/move_base", 1, {"/move_base /sim_bridge /cmd_vel": 3})
    assert coordinator.unanswered() == []
    assert coordinator.sent_counts() == {"/amcl /move_base /tf": 1, "/move_base /sim_bridge /cmd_vel": 3}


def test_a_latency_beyond_the_next_tick_is_cut_there():
    assert coordinator_of("/move_base", latency=0.5).latency == pytest.approx(0.1)
    assert coordinator_of("/move_base", latency=0.5, period=0.04).latency == pytest.approx(0.04)


def test_a_node_that_is_removed_is_not_waited_for():
    coordinator = coordinator_of("/amcl", "/move_base")
    coordinator.begin_tick(0.0)
    coordinator.record_answer("/amcl", 1, {})
    coordinator.remove_member("/move_base")
    assert coordinator.unanswered() == []
    assert coordinator.members == {"/amcl"}
    assert coordinator.begin_tick(0.02) == (2, True)


def test_after_a_reset_of_time_nodes_must_still_answer_the_current_tick():
    coordinator = coordinator_of("/amcl")
    coordinator.begin_tick(7.0)
    coordinator.reset_time()
    assert coordinator.delivery_due(0.0)
    assert coordinator.unanswered() == ["/amcl"]
    coordinator.record_answer("/amcl", 1, {})
    assert coordinator.begin_tick(0.0) == (2, True)


def test_messages_to_a_removed_node_are_not_expected_by_the_next_node_of_its_name():
    coordinator = coordinator_of("/amcl", "/move_base")
    coordinator.begin_tick(0.0)
    coordinator.record_answer("/amcl", 1, {"/amcl /move_base /tf": 7, "/amcl /sim_bridge /tf": 7})
    coordinator.remove_member("/move_base")
    coordinator.add_member("/move_base", 0.1)
    assert coordinator.sent_counts() == {"/amcl /sim_bridge /tf": 7}
