"""Who is waited for, and what takes effect when."""

import pytest

from sim_bridge.coordination import LockStepCoordinator

STEP = 0.02


def conductor_of(*names, latency=0.1, period=0.1):
    conductor = LockStepCoordinator(latency)
    for name in names:
        conductor.add_node(name, period)
    return conductor


def stamps_of_moments(conductor, until):
    """Times at which moments begin if every node answers at once."""
    found, step = [], 0
    while step * STEP < until:
        begun = conductor.begin_tick(step * STEP)
        if begun is not None:
            found.append(round(step * STEP, 6))
            for name in conductor.members:
                conductor.acknowledge(name, begun[0], {})
        step += 1
    return found


def test_without_nodes_there_are_no_moments():
    assert stamps_of_moments(conductor_of(), 1.0) == []


def test_moments_are_at_multiples_of_the_shortest_period():
    assert stamps_of_moments(conductor_of("/amcl"), 0.45) == [0.0, 0.1, 0.2, 0.3, 0.4]
    quick = conductor_of("/amcl")
    quick.add_node("/move_base", 0.04)
    assert stamps_of_moments(quick, 0.17) == [0.0, 0.04, 0.08, 0.12, 0.16]


def test_a_node_that_joins_late_gets_a_moment_at_once_with_all_members():
    conductor = conductor_of("/amcl")
    assert conductor.begin_tick(0.0) == (1, True)
    assert conductor.begin_tick(0.04) is None
    conductor.add_node("/move_base", 0.1)
    assert conductor.begin_tick(0.06) == (2, True)
    assert conductor.begin_tick(0.1) == (3, False)


def test_time_may_pass_until_what_is_sent_takes_effect():
    conductor = conductor_of("/amcl", "/move_base", latency=0.06)
    conductor.begin_tick(0.0)
    conductor.acknowledge("/amcl", 1, {"/amcl /move_base /tf": 1})
    assert not conductor.is_complete(0.04)
    assert conductor.is_complete(0.06)
    assert conductor.pending_nodes() == ["/move_base"]
    conductor.acknowledge("/move_base", 1, {"/move_base /sim_bridge /cmd_vel": 3})
    assert conductor.pending_nodes() == []
    assert conductor.effective_counts() == {"/amcl /move_base /tf": 1, "/move_base /sim_bridge /cmd_vel": 3}


def test_a_latency_beyond_the_next_moment_is_cut_there():
    assert conductor_of("/move_base", latency=0.5).latency == pytest.approx(0.1)
    assert conductor_of("/move_base", latency=0.5, period=0.04).latency == pytest.approx(0.04)


def test_a_node_that_is_dismissed_is_not_waited_for_and_told_so():
    conductor = conductor_of("/amcl", "/move_base")
    conductor.begin_tick(0.0)
    conductor.acknowledge("/amcl", 1, {})
    conductor.remove_node("/move_base")
    assert conductor.pending_nodes() == []
    assert conductor.members == {"/amcl"}
    assert conductor.begin_tick(0.02) == (2, True)


def test_after_a_restart_of_time_nodes_must_still_answer_what_they_are_at():
    conductor = conductor_of("/amcl")
    conductor.begin_tick(7.0)
    conductor.restart()
    assert conductor.is_complete(0.0)
    assert conductor.pending_nodes() == ["/amcl"]
    conductor.acknowledge("/amcl", 1, {})
    assert conductor.begin_tick(0.0) == (2, True)


def test_what_was_sent_to_a_node_that_has_gone_is_not_asked_of_the_next_of_its_name():
    conductor = conductor_of("/amcl", "/move_base")
    conductor.begin_tick(0.0)
    conductor.acknowledge("/amcl", 1, {"/amcl /move_base /tf": 7, "/amcl /sim_bridge /tf": 7})
    conductor.remove_node("/move_base")
    conductor.add_node("/move_base", 0.1)
    assert conductor.effective_counts() == {"/amcl /sim_bridge /tf": 7}
