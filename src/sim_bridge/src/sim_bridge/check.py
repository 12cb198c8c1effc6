"""Contract check of a user-defined kind of fault: ``python3 -m sim_bridge.check NAME``.

Each check is given the name of a kind.
"""

import sys
from typing import List, Tuple

import numpy as np

from planar import Pose2, Scan, Twist2
from planar.plugin_check import CheckSuite, expect, plugin_finder, run_checks
from sim_bridge.faults import Fault, FaultContext, FaultInjector, kind_named
from sim_bridge.faults.custom import CONTRACT
from sim_bridge.faults.registry import make_fault
from sim_bridge.geometry.shapes import Plane
from sim_bridge.sensors.odometry import Odometry
from sim_bridge.simulation import ROBOT_NAME, Simulation, box_on_floor
from sim_bridge.world import Body, Collision, World

SPEED, SECONDS, BEGIN, END = Twist2(0.3, 0.4), 1.0, 0.3, 0.7


def has_a_docstring(kind: str) -> None:
    """The first line of its docstring states the effect."""
    docstring = kind_named(kind).__dict__.get("__doc__") or ""
    expect(bool(docstring.strip()), "it has no docstring")


def accepts_any_strength(kind: str) -> None:
    """It returns valid values at its default, least and largest strength."""
    for strength in kind_named(kind).strength:
        fault = make_fault(kind, strength, np.random.default_rng(0))
        for number in range(10):
            fault.scan(_scan(0.1 * number))
            fault.odometry(Odometry(Pose2(0.1 * number, 0.0), SPEED))
            fault.command(SPEED)
            fault.wheel_speeds(5.0, 6.0)


def does_not_change_arguments(kind: str) -> None:
    """It does not change its arguments: a faulty scan is a new object."""
    fault, scan = make_fault(kind, kind_named(kind).strength[0], np.random.default_rng(0)), _scan(0.0)
    before = scan.ranges.copy()
    fault.scan(scan)
    expect(np.array_equal(scan.ranges, before, equal_nan=True), "it has changed the scan in place")


def is_repeatable(kind: str) -> None:
    """Its randomness is from rng: the same seed gives the same run, in which it begins and ends."""
    first, second = (_run(kind) for _ in range(2))
    expect(first == second, "two runs with the same seed differ")


def _scan(stamp: float) -> Scan:
    return Scan(stamp, -1.5, 0.1, np.linspace(0.5, 4.0, 31, dtype=np.float32), 0.1, 10.0)


def _run(kind: str) -> List[Tuple[str, bytes]]:
    """Return what a robot measures that drives past a box while the fault begins and ends."""
    faults = FaultInjector([Fault(kind, BEGIN, END, kind_named(kind).strength[0], seed=1)])
    floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
    world = World("room", (floor, box_on_floor("box", (0.5, 0.5, 1.0), Pose2(2.0, 0.3))))
    simulation, measured = Simulation(world, wrappers=faults.wrappers), []
    try:
        result = simulation.step(SPEED)
        while result.stamp < SECONDS:
            context = FaultContext(simulation.scene, ROBOT_NAME, result.base_in_world)
            faults.update(result.stamp, context)
            result = simulation.step(SPEED)
            scans = b"".join(scan.ranges.tobytes() for scan in result.scans)
            measured.append((repr((result.truth, result.odometry)), scans))
    finally:
        simulation.close()
    return measured


def _check_name(name: str) -> str:
    kind_named(name)
    return name


CHECKS = (has_a_docstring, accepts_any_strength, does_not_change_arguments, is_repeatable)
CHECK_SUITES = {"fault": CheckSuite(plugin_finder(CONTRACT, _check_name), CHECKS)}


if __name__ == "__main__":
    sys.exit(run_checks("sim_bridge", CHECK_SUITES))
