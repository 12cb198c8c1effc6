"""PyBullet prints nothing."""

import os
import subprocess
import sys

SIMULATE = """
from sim_bridge import Simulation
from sim_bridge.world import Body, Collision, World
from sim_bridge.geometry.shapes import Plane
import numpy
floor = World("floor", (Body("floor::link", numpy.eye(4), (Collision(Plane(), numpy.eye(4)),)),))
print(Simulation(floor).step().stamp)
"""

ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}


def test_a_simulation_prints_nothing():
    ended = subprocess.run(
        [sys.executable, "-c", SIMULATE],
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (ended.stdout, ended.stderr, ended.returncode) == ("0.02\n", "", 0)


def test_it_can_be_imported_without_standard_streams():
    ended = subprocess.run(
        ["/bin/sh", "-c", '"$0" -c "import sim_bridge" >&- 2>&-', sys.executable],
        env=ENVIRONMENT,
        timeout=120,
        check=False,
    )
    assert ended.returncode == 0
