#!/usr/bin/env bash
# PyBullet 3.2.7: contactBreakingThreshold belongs to the process, not to the client that sets it.
#
# Guess:  setPhysicsEngineParameter(..., physicsClientId=a) affects the simulation of client a; another client in the
#         same process, connected with DIRECT, has a separate world, and resetSimulation gives the defaults.
# Is:     once one client has set contactBreakingThreshold, a box that is thrown in any other client comes to rest
#         elsewhere, in clients made before and after, also after resetSimulation and after the client that set it
#         has disconnected. getPhysicsEngineParameters does not report the value.
# Means:  a process that simulates several worlds repeats only if none of them sets this parameter, or all set it alike.
#
# Installs pybullet into a temporary folder and runs it alone. Exit code 1 if it behaves differently.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf -- "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --only-binary :all: pybullet==3.2.7 numpy==1.24.4
"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import pybullet


def place_of_rest(client):
    """Where a box that is thrown onto a floor comes to rest in a client, rounded to 0.1 mm."""
    pybullet.resetSimulation(physicsClientId=client)
    pybullet.setGravity(0, 0, -9.8, physicsClientId=client)
    plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=client)
    pybullet.createMultiBody(0, plane, physicsClientId=client)
    shape = pybullet.createCollisionShape(
        pybullet.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1], physicsClientId=client
    )
    turned = pybullet.getQuaternionFromEuler([0.3, 0.2, 0.0])
    box = pybullet.createMultiBody(1.0, shape, -1, [0, 0, 0.3], turned, physicsClientId=client)
    pybullet.resetBaseVelocity(box, [1.0, 0, 0], [3, 2, 1], physicsClientId=client)
    for _ in range(400):
        pybullet.stepSimulation(physicsClientId=client)
    position, _ = pybullet.getBasePositionAndOrientation(box, physicsClientId=client)
    return tuple(round(value, 4) for value in position)


print("pybullet", version("pybullet"))
first, other = pybullet.connect(pybullet.DIRECT), pybullet.connect(pybullet.DIRECT)
before = place_of_rest(first)
again = place_of_rest(first)
pybullet.setPhysicsEngineParameter(contactBreakingThreshold=0.001, physicsClientId=other)
pybullet.disconnect(other)
after = place_of_rest(first)
later = place_of_rest(pybullet.connect(pybullet.DIRECT))
print("first client:", before, "and again", again)
print("first client, after another one set contactBreakingThreshold and disconnected:", after)
print("client that is connected afterwards:", later)
same = before == again and after != before and later == after
print("as described" if same else "changed: clients no longer share the threshold, or runs do not repeat")
sys.exit(not same)
PYTHON
