"""What a kind of fault of somebody's own has to do: ``python3 -m sim_bridge.check NAME``.

Each check is given the name of a kind.
"""

import sys
from typing import List, Tuple

import numpy as np

from planar import Pose2, Scan, Twist2
from planar.contract_check import CheckSuite, expect, plugin_finder, run_checks
from sim_bridge.faults import Fault, FaultContext, FaultInjector, kind_named
from sim_bridge.faults.custom import CONTRACT
from sim_bridge.faults.registry import make_fault
from sim_bridge.geometry.shapes import Plane
from sim_bridge.sensors.odometry import Odometry
from sim_bridge.simulation import ROBOT_NAME, Simulation, box_on_floor
from sim_bridge.world import Body, Collision, World

SPEED, SECONDS, BEGIN, END = Twist2(0.3, 0.4), 1.0, 0.3, 0.7


def says_what_goes_wrong(kind: str) -> None:
    """Its docstring says in a line what goes wrong."""
    own = kind_named(kind).__dict__.get("__doc__") or ""
    expect(bool(own.strip()), "it has none")


def answers_at_any_strength(kind: str) -> None:
    """With its usual, least and largest strength it gives what robots can have."""
    for strength in kind_named(kind).strength:
        fault = make_fault(kind, strength, np.random.default_rng(0))
        for number in range(10):
            fault.scan(_scan(0.1 * number))
            fault.odometry(Odometry(Pose2(0.1 * number, 0.0), SPEED))
            fault.command(SPEED)
            fault.wheel_speeds(5.0, 6.0)


def leaves_scans_as_they_are(kind: str) -> None:
    """What it is given stays as it was: a changed scan is another one."""
    fault, scan = make_fault(kind, kind_named(kind).strength[0], np.random.default_rng(0)), _scan(0.0)
    before = scan.ranges.copy()
    fault.scan(scan)
    expect(np.array_equal(scan.ranges, before, equal_nan=True), "the scan is another after the call")


def repeats_itself(kind: str) -> None:
    """All chance comes from rng: the same seeds give the same run, in which it begins and ends."""
    first, second = (_run(kind) for _ in range(2))
    expect(first == second, "another run with the same seed")


def _scan(stamp: float) -> Scan:
    return Scan(stamp, -1.5, 0.1, np.linspace(0.5, 4.0, 31, dtype=np.float32), 0.1, 10.0)


def _run(kind: str) -> List[Tuple[str, bytes]]:
    """What a robot tells that drives past a box while the fault begins and ends."""
    faults = FaultInjector([Fault(kind, BEGIN, END, kind_named(kind).strength[0], seed=1)])
    floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
    world = World("room", (floor, box_on_floor("box", (0.5, 0.5, 1.0), Pose2(2.0, 0.3))))
    simulation, told = Simulation(world, wrappers=faults.wrappers), []
    try:
        observation = simulation.step(SPEED)
        while observation.stamp < SECONDS:
            faults.update(
                observation.stamp, FaultContext(simulation.scene, ROBOT_NAME, observation.base_in_world)
            )
            observation = simulation.step(SPEED)
            scans = b"".join(scan.ranges.tobytes() for scan in observation.scans)
            told.append((repr((observation.truth, observation.odometry)), scans))
    finally:
        simulation.close()
    return told


def _is_own(name: str) -> str:
    kind_named(name)
    return name


CHECKS = (says_what_goes_wrong, answers_at_any_strength, leaves_scans_as_they_are, repeats_itself)
KITS = {"fault": CheckSuite(plugin_finder(CONTRACT, _is_own), CHECKS)}


if __name__ == "__main__":
    sys.exit(run_checks("sim_bridge", KITS))
