"""The node ``sim_bridge`` with the world of a scenario."""

from pathlib import Path

from laboratory.scenario import read_scenario
from planar_ros.lockstep.transport import LockstepConnection
from planar_ros.node.runner import run
from rospy_transport.replacements import install
from sim_bridge.config import BridgeSettings
from sim_bridge.ros.node import Bridge
from sim_bridge.world import World


def main():
    install(LockstepConnection)
    run("sim_bridge", lambda: Bridge(_world_of).run())


def _world_of(settings: BridgeSettings) -> World:
    """Load the scenario named by ``~world``. Raises PlanarError."""
    return read_scenario(Path(settings.world)).arena(settings.seed).world
