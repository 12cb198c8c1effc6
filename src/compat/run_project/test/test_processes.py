"""Which processes of a project start, sleep, or get a lower priority."""

import subprocess
import sys
import time
from types import SimpleNamespace

import psutil
import pytest

from run_project.ros.graph_nodes import ATTEMPTS, GraphNodes
from run_project.ros.processes import (
    BEGIN_SECONDS,
    BUSY_NICENESS,
    LONG_SLEEP_SECONDS,
    NODE_SECONDS,
    PROGRAM_SECONDS,
    BusyProcesses,
    FirstSleeps,
    ListedProcess,
    WallSleeps,
    is_time_due,
    starting_seconds,
)
from run_project.stand_ins import STAND_INS


class FakeProcess:
    pid = 2**22 + 1  # above the largest one

    def __init__(self, cpu_share, rests_per_second):
        self.cpu_share, self.rests_per_second = cpu_share, rests_per_second
        self.seconds, self.niceness = 0.0, 0

    def threads(self):
        used = self.cpu_share * self.seconds
        other = SimpleNamespace(id=self.pid + 1, user_time=self.seconds, system_time=0.0)
        return [other, SimpleNamespace(id=self.pid, user_time=used, system_time=0.0)]

    def num_ctx_switches(self):
        return SimpleNamespace(voluntary=int(self.rests_per_second * self.seconds))

    def nice(self, value=None):
        self.niceness = self.niceness if value is None else value
        return self.niceness


@pytest.mark.parametrize(
    ("cpu_share", "rests_per_second", "niceness"),
    [(0.9, 0.0, BUSY_NICENESS), (0.4, 0.5, BUSY_NICENESS), (0.8, 10.0, 0), (0.02, 0.0, 0)],
)
def test_only_nodes_that_spin_without_sleeping_get_a_lower_priority(cpu_share, rests_per_second, niceness):
    process, busy = FakeProcess(cpu_share, rests_per_second), BusyProcesses()
    for second in range(12):
        process.seconds = float(second)
        busy.lower_priority([process], float(second))
    assert process.niceness == niceness


@pytest.mark.parametrize(
    ("command", "has_children", "is_node", "seconds"),
    [
        (["python3", "/opt/ros/bin/roslaunch", "robot", "world.launch"], False, False, NODE_SECONDS),
        (["python3", "/opt/ros/bin/roslaunch", "robot", "world.launch"], True, False, 0.0),
        (["/ws/devel/lib/robot/drive", "__name:=drive", "__log:=x"], False, False, NODE_SECONDS),
        (["/opt/ros/lib/amcl/amcl", "__name:=amcl"], False, True, 0.0),
        (["/ws/devel/lib/robot/pick_objects"], False, False, PROGRAM_SECONDS),
        (["/ws/devel/lib/robot/pick_objects"], False, True, 0.0),
        (["bash", "/opt/ros/bin/rosrun", "robot", "pick_objects"], True, False, 0.0),
        (
            ["bash", "-c", "source devel/setup.bash; roslaunch robot world.launch"],
            False,
            False,
            PROGRAM_SECONDS,
        ),
        (["bash", "home_service.sh"], True, False, 0.0),
        (["python3", str(STAND_INS / "bin" / "xterm"), "-e", "roslaunch"], False, False, PROGRAM_SECONDS),
        (["python3", str(STAND_INS / "bin" / "sleep"), "5"], False, False, 0.0),
        (["python3", str(STAND_INS / "lib" / "rviz" / "rviz"), "__name:=rviz"], False, False, 0.0),
    ],
)
def test_a_program_counts_as_starting_until_it_is_a_node(command, has_children, is_node, seconds):
    listed = ListedProcess(None, 1, "name", command, 0.0)
    assert starting_seconds(listed, has_children, is_node) == seconds


SLEEP_CODE = "import time; print(flush=True); time.sleep(60)"
LOOP_CODE = "import time; print(flush=True)\nwhile True: time.sleep(0.1)"
TIMED_WAIT_CODE = """
import threading
threading.Timer(60.0, print).start()
print(flush=True)
threading.Event().wait()
"""
WAIT_CODE = "import threading; print(flush=True); threading.Event().wait()"


@pytest.mark.parametrize(
    ("code", "is_sleeping"),
    [(SLEEP_CODE, True), (TIMED_WAIT_CODE, True), (LOOP_CODE, False), (WAIT_CODE, False)],
)
def test_a_thread_that_sleeps_for_long_is_noticed(code, is_sleeping):
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    try:
        process.stdout.readline()
        sleeps, listed = WallSleeps(), [psutil.Process(process.pid)]
        time.sleep(0.3)
        assert not sleeps.are_any(listed, 0.0)
        time.sleep(0.3)
        assert sleeps.are_any(listed, LONG_SLEEP_SECONDS + 0.1) == is_sleeping
    finally:
        process.kill()
        process.wait()


@pytest.mark.parametrize(
    ("command", "age", "is_sleeping"),
    [
        (["sleep", "60"], 1.0, True),
        (["sleep", "60"], BEGIN_SECONDS + 0.1, False),
        ([sys.executable, "-c", SLEEP_CODE], 1.0, False),
        (["cat"], 1.0, False),
    ],
)
def test_a_program_that_sleeps_as_it_begins_is_noticed(command, age, is_sleeping):
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    try:
        listed = [ListedProcess(psutil.Process(process.pid), 1, command[0], command, age)]
        time.sleep(0.3)
        sleeps = FirstSleeps()
        assert not sleeps.are_any(listed)
        time.sleep(0.1)
        assert sleeps.are_any(listed) == is_sleeping
    finally:
        process.kill()
        process.communicate()


def test_a_process_that_has_ended_does_not_sleep():
    process = subprocess.Popen(["true"])
    listed = [psutil.Process(process.pid)]
    process.wait()
    assert not WallSleeps().are_any(listed, 0.0)


def test_nodes_are_asked_for_their_process_until_they_answer():
    answers, asked = {"/a": [None, 5], "/b": [None] * 9}, []

    def ask(name):
        asked.append(name)
        return answers[name].pop(0)

    nodes = GraphNodes(ask)
    for _ in range(6):
        nodes.update(["/a", "/b"])
    assert nodes.pids == {5}
    assert asked.count("/a") == 2
    assert asked.count("/b") == ATTEMPTS
    assert nodes.names == {"a", "b"}
    nodes.update(["/b"])
    assert (nodes.pids, nodes.names) == (frozenset(), {"b"})


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        (["python3", "/opt/ros/lib/gazebo_ros/gzserver", "-e", "ode", "home.world"], True),
        (["gzserver", "home.world"], True),
        (["bash", "/opt/ros/lib/gazebo_ros/debug", "home.world"], True),
        (["python3", "/opt/ros/lib/gazebo_ros/spawn_model", "-urdf"], False),
        (["python3", "/opt/ros/bin/roslaunch", "robot", "gazebo"], False),
        ([], False),
    ],
)
def test_simulators_are_known_by_their_program(command, expected):
    assert is_time_due([["bash"], command], "", frozenset()) == expected


@pytest.mark.parametrize(("present", "expected"), [({"amcl", "x"}, False), ({"amcl", "planner"}, True)])
def test_time_is_not_due_while_the_simulator_waits_for_nodes_that_are_not_there(present, expected):
    assert is_time_due([["gzserver"]], "amcl robot/planner", present) == expected
