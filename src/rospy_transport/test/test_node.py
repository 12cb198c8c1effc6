"""Time, names and shutdown of rospy."""

import subprocess
import sys
import threading
import time

import pytest
import rospy
import rospy.names
from rospy.impl import rosout
from rospy.impl.registration import RegManager, get_registration_listeners

from rospy_transport import node

SHUTDOWN = """
import rospy
from rospy.impl.registration import RegManager
from std_msgs.msg import String

from rospy_transport import node

registrations = RegManager(None)  # as rospy.init_node makes it
registrations.uri, registrations.master_uri = "http://127.0.0.1:1", "http://127.0.0.1:2"  # nobody is there
topic = rospy.Publisher("/topic", String, queue_size=1)

def report(name):
    print(name, topic.impl.closed, node.is_shutting_down(), rospy.is_shutdown())

report("before")
rospy.on_shutdown(lambda: report("on_shutdown"))
node.on_topics_closed(lambda: report("on_topics_closed"))
node.on_unregistered(lambda: report("on_unregistered"))
rospy.signal_shutdown("test")
"""


def test_the_registration_thread_ends_at_once_at_a_shutdown(monkeypatch):
    """It would look for the shutdown half a second later."""
    manager = RegManager(None)
    monkeypatch.setattr(get_registration_listeners(), "listeners", [manager])
    hooks = []
    monkeypatch.setattr(node.rospy.core, "add_shutdown_hook", hooks.append)
    node.end_registration_at_shutdown()
    is_waiting, is_woken = threading.Event(), threading.Event()

    def wait():
        with manager.cond:
            is_waiting.set()
            if manager.cond.wait(30.0):
                is_woken.set()

    threading.Thread(target=wait, daemon=True).start()
    assert is_waiting.wait(10.0)
    (wake,) = hooks
    wake("test")
    assert is_woken.wait(10.0)


def test_the_hooks_of_a_shutdown_are_called_in_order():
    run = subprocess.run(
        [sys.executable, "-c", SHUTDOWN], capture_output=True, text=True, timeout=60.0, check=True
    )
    assert run.stdout.splitlines() == [
        "before False False False",
        "on_shutdown False True False",
        "on_topics_closed True True False",
        "on_unregistered True True True",
    ]


def test_a_process_is_a_node_only_once_it_is_initialized():
    assert node.is_initialized()  # see conftest.py
    command = "from rospy_transport import node; print(node.is_initialized(), node.is_shutting_down())"
    run = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True, check=True)
    assert run.stdout == "False False\n"


def test_simulated_time_is_set_and_waited_for():
    assert node.is_wall_clock()
    node.set_time(rospy.Time(5))
    assert not node.is_wall_clock()
    assert rospy.Time.now() == rospy.Time(5)
    stamps = []
    waiting = threading.Thread(target=lambda: stamps.append(node.sleep_until(rospy.Time(7))))
    waiting.start()
    node.set_time(rospy.Time(6))
    time.sleep(0.05)
    assert stamps == []
    node.set_time(rospy.Time(8))
    waiting.join(node.LONGEST_WAIT_SECONDS / 2)
    assert stamps == [rospy.Time(8)]
    with pytest.raises(rospy.ROSTimeMovedBackwardsException):
        node.sleep_until(rospy.Time(9), since=rospy.Time(8, 1))


def test_wall_time_is_waited_for_as_well():
    due = rospy.Time.now() + rospy.Duration.from_sec(0.05)
    assert node.sleep_until(due) >= due


def test_names_are_remapped_as_on_the_command_line_of_now(monkeypatch):
    monkeypatch.setattr(sys, "argv", ["node", "scan:=laser", "odom:=wheels"])
    node.reload_remappings()
    rospy.names.initialize_mappings("/node")
    assert [rospy.resolve_name(name) for name in ("scan", "odom")] == ["/laser", "/wheels"]
    node.discard_remapping("/scan")
    node.discard_remapping("/never")
    assert [rospy.resolve_name(name) for name in ("scan", "odom")] == ["/scan", "/wheels"]
    monkeypatch.undo()
    node.reload_remappings()


def test_a_cached_parameter_is_not_subscribed_to(monkeypatch):
    """rospy reads this one with each log message, from the cache if it is there."""
    asked = []
    monkeypatch.setattr(rosout, "_rosout_pub", type("Topic", (), {"publish": asked.append}))
    node.cache_parameter("/rosout_disable_topics_generation", True)
    rosout._rosout(2, "text", "file", 1, "function")  # without a master it would fail
    assert [message.msg for message in asked] == ["text"]
    assert not asked[0].topics
