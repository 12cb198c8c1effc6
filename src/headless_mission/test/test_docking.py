"""Docking in the simulator, in one process."""

import math
from dataclasses import replace
from typing import Optional

import numpy as np
import pytest

from auto_docking_lite import DockCode, DockController, DockResult
from headless_mission.docking import DockingHooks
from planar import Pose2
from sim_bridge import Episode, EpisodeHooks, Simulation
from sim_bridge.docks import DOCK_NAME, with_dock
from sim_bridge.geometry.shapes import Plane
from sim_bridge.simulation import box_on_floor
from sim_bridge.world import Body, Collision, World

FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
ROOM = World("room", (FLOOR, box_on_floor("wall", (0.1, 4.0, 1.0), Pose2(-0.13, 0.0))))
START = Pose2(1.6, 0.7, 1.0)


class Docking:
    """An episode in which the robot docks.

    Args:
        world: The world with its docks.
        start: Start pose of the robot.
        dock: Where the dock is expected, in the world; None: unknown.
        hooks: Further hooks.
    """

    def __init__(
        self,
        world: World,
        start: Pose2 = START,
        dock: Optional[Pose2] = None,
        hooks: Optional[EpisodeHooks] = None,
    ):
        self.simulation = Simulation(world, base_in_world=start, seed=3)
        self.controller = DockController()
        docking = DockingHooks(self.controller)
        docking.odom_in_map = start
        self._docking = docking
        self._episode = Episode(
            self.simulation, 0.1, 0.1, hooks=[docking, *([hooks] if hooks is not None else [])]
        )
        self.controller.start(0.0, dock)

    def run(self, seconds: float = 240.0) -> Optional[DockResult]:
        """Advance until the end of the task; None if it takes longer."""
        while True:
            self.step = self._episode.advance()
            if self._docking.decision.result is not None or self.step.stamp > seconds:
                return self._docking.decision.result


def test_the_robot_docks_charges_and_leaves():
    docking = Docking(with_dock(ROOM, Pose2()))
    assert docking.run().is_success
    assert docking.step.kobuki.power.charger == 6
    docking.controller.undock(docking.step.stamp)
    result = docking.run()
    assert result.is_success and docking.step.base_in_world.x > 0.5
    assert docking.step.kobuki.power.charger == 0


@pytest.mark.parametrize("moved", [Pose2(0.5, 0.0), Pose2(0.3, -0.4, 0.15)])
def test_a_dock_that_was_moved_by_half_a_metre_is_found(moved):
    docking = Docking(with_dock(ROOM, moved), Pose2(3.2, 1.0, 2.0), dock=Pose2())
    assert docking.run().is_success


def test_a_dock_behind_a_wall_is_not_found_and_nothing_is_touched():
    between = box_on_floor("between", (0.1, 3.0, 1.0), Pose2(0.5, 0.0))
    docking = Docking(with_dock(replace(ROOM, bodies=(*ROOM.bodies, between)), Pose2()), dock=Pose2())
    result = docking.run()
    assert result.code in (DockCode.FAILED_TO_STAGE, DockCode.FAILED_TO_DETECT_DOCK), result
    assert not docking.step.contacts


def test_without_a_dock_there_is_a_reason():
    result = Docking(ROOM).run()
    assert result.code is DockCode.FAILED_TO_DETECT_DOCK and "no signal of a dock" in result.text


def test_with_two_docks_the_robot_charges_at_one():
    two = with_dock(with_dock(ROOM, Pose2(0.0, 0.8)), Pose2(0.0, -0.8), "second")
    docking = Docking(two)
    assert docking.run().is_success and docking.step.kobuki.power.charger == 6


def test_a_dock_that_vanishes_during_the_approach_is_lost():
    class Remove(EpisodeHooks):
        def before_step(self, episode: Episode) -> None:
            scene = episode.simulation.scene
            if scene.stamp > 6.0 and DOCK_NAME in scene.models.names():
                scene.remove_model(DOCK_NAME)

    docking = Docking(with_dock(ROOM, Pose2()), hooks=Remove())
    result = docking.run()
    assert result is not None and not result.is_success


def test_the_same_seed_gives_the_same_docking():
    ends = []
    for _ in range(2):
        docking = Docking(with_dock(ROOM, Pose2()), Pose2(1.0, 0.2, math.pi))
        assert docking.run().is_success
        ends.append((docking.step.stamp, docking.step.base_in_world))
    assert ends[0] == ends[1]
