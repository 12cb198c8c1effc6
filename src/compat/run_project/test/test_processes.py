"""Which nodes of a project get a lower priority."""

from types import SimpleNamespace

import pytest

from run_project.ros.processes import (
    BUSY_NICENESS,
    NODE_SECONDS,
    PROGRAM_SECONDS,
    BusyProcesses,
    starting_seconds,
)


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
    ("command", "has_children", "is_of_project", "seconds"),
    [
        (["python3", "/opt/ros/bin/roslaunch", "robot", "world.launch"], False, False, NODE_SECONDS),
        (["python3", "/opt/ros/bin/roslaunch", "robot", "world.launch"], True, False, 0.0),
        (["/ws/devel/lib/robot/drive", "__name:=drive", "__log:=x"], False, True, NODE_SECONDS),
        (["/opt/ros/lib/amcl/amcl", "__name:=amcl"], False, False, 0.0),
        (["/ws/devel/lib/robot/pick_objects"], False, True, PROGRAM_SECONDS),
        (["bash", "/opt/ros/bin/rosrun", "robot", "pick_objects"], True, False, 0.0),
    ],
)
def test_a_program_counts_as_starting_until_it_is_a_node(command, has_children, is_of_project, seconds):
    nodes = {"/amcl", "/home/move_base"}
    assert starting_seconds(command, has_children, is_of_project, nodes) == seconds
