import subprocess
import sys
import threading
from types import SimpleNamespace

import pytest

from supervision import interruption
from supervision.errors import LaunchError
from supervision.node_exits import NodeFailure
from supervision.ros import supervisor
from supervision.ros.supervisor import Supervisor

# Ctrl-C arrives during the start: there is a process, but the graph has no reference to it yet.
INTERRUPTED = """
import subprocess, sys
from pathlib import Path
from types import SimpleNamespace
import psutil
from supervision.interruption import RunInterruptedError
from supervision.ros import graph
from supervision.ros.supervisor import Supervisor

def interrupted(_command, popen=subprocess.Popen, **_options):
    popen([sys.executable, "-c", "import time; time.sleep(60.0)"])
    raise RunInterruptedError

graph.shutil.which = lambda name: name
graph.subprocess.Popen = interrupted
supervisor = Supervisor(SimpleNamespace(), Path(sys.argv[1]), 60.0)
try:
    supervisor.start("home_service", "world.launch", {})
except RunInterruptedError:
    print("interrupted with", len(psutil.Process().children()))
supervisor.end()
ended = psutil.STATUS_ZOMBIE
print("ended with", sum(child.status() != ended for child in psutil.Process().children()))
"""


@pytest.fixture
def graph(monkeypatch):
    exits = SimpleNamespace(failure=None, restarts=[])
    graph = SimpleNamespace(exits=exits, is_running=True, how_it_ended="ended", log_gap=None)
    monkeypatch.setattr(supervisor, "RosGraph", lambda *_: graph)
    monkeypatch.setattr(supervisor, "unresponsive_nodes", list)
    return graph


def supervised(tmp_path, time_limit=60.0):
    display = SimpleNamespace(show=lambda status: None, print=lambda text: None)
    watcher = Supervisor(display, tmp_path, time_limit)
    watcher.start("home_service", "world.launch", {})
    return watcher


def test_a_watch_ends_when_its_work_is_done(graph, tmp_path):
    asked = iter((False, False, True))
    assert supervised(tmp_path).watch(lambda: next(asked), str) is None


def test_a_watch_ends_with_the_error_of_a_dead_node(graph, tmp_path):
    graph.exits.failure = NodeFailure("amcl: no map", is_bad_input=False)
    assert supervised(tmp_path).watch(lambda: False, str) == "amcl: no map"


def test_a_node_that_refuses_its_input_is_an_error(graph, tmp_path):
    graph.exits.failure = NodeFailure("amcl: max_particles must be at least 1", is_bad_input=True)
    with pytest.raises(LaunchError, match="max_particles") as error:
        supervised(tmp_path).watch(lambda: False, str)
    assert error.value.is_bad_input


def test_a_watch_gives_up_in_time(graph, tmp_path):
    reason = supervised(tmp_path, time_limit=0.05).watch(lambda: False, str)
    assert reason == "not done within 0.05 s of wall-clock time"


def test_a_watch_that_times_out_names_unresponsive_nodes(graph, tmp_path, monkeypatch):
    monkeypatch.setattr(supervisor, "unresponsive_nodes", lambda: ["amcl", "map_server"])
    reason = supervised(tmp_path, time_limit=0.05).watch(lambda: False, str)
    assert reason == "not done within 0.05 s of wall-clock time; no answer of amcl, map_server"


def test_what_was_waited_for_when_the_graph_ended_is_named(graph, tmp_path):
    graph.is_running = False
    with pytest.raises(LaunchError) as error:
        supervised(tmp_path).wait_for("the simulator", lambda: False)
    assert str(error.value) == f"roslaunch ended before the simulator was there, see {tmp_path}"
    assert supervised(tmp_path).watch(lambda: False, str) == f"roslaunch ended, see {tmp_path}"


def test_work_that_waits_for_ever_ends_with_the_graph(graph, tmp_path):
    supervised_graph, never = supervised(tmp_path), threading.Event()

    def lose_the_master():
        graph.is_running = False
        never.wait()

    with pytest.raises(LaunchError, match="roslaunch ended before the node was there"):
        supervised_graph.run_in_thread("the node", lose_the_master)
    assert supervised_graph.has_pending_work
    never.set()


def test_a_refused_connection_is_the_end_of_the_graph(graph, tmp_path):
    def be_refused():
        graph.is_running = False
        raise ConnectionRefusedError

    with pytest.raises(LaunchError, match="roslaunch ended before the node was there"):
        supervised(tmp_path).run_in_thread("the node", be_refused)


def test_another_error_in_the_thread_is_raised(graph, tmp_path):
    with pytest.raises(ZeroDivisionError):
        supervised(tmp_path).run_in_thread("the node", lambda: 1 / 0)


def test_the_signal_that_killed_roslaunch_is_reported(graph, tmp_path):
    graph.is_running, graph.how_it_ended = False, "was ended by SIGKILL"
    reason = supervised(tmp_path).watch(lambda: False, str)
    assert reason == f"roslaunch was ended by SIGKILL, see {tmp_path}"


def test_the_end_of_the_graph_is_explained_after_an_interrupt_too(graph, tmp_path, monkeypatch):
    monkeypatch.setattr(interruption, "_is_interrupted", True)
    watcher = supervised(tmp_path)
    graph.exits.failure = NodeFailure("sim_bridge: was ended by SIGKILL", is_bad_input=False)
    assert watcher.end_of_graph is None
    graph.is_running = False
    assert watcher.end_of_graph == "sim_bridge: was ended by SIGKILL"


def test_a_graph_whose_start_is_interrupted_ends_too(tmp_path):
    command = [sys.executable, "-c", INTERRUPTED, str(tmp_path)]
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    assert result.stdout.splitlines() == ["interrupted with 1", "ended with 0"]
