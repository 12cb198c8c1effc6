"""Docks that charge a Kobuki: putting one into a world."""

from dataclasses import replace
from typing import Tuple

from planar import Pose2
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.sdf.reader import MODELS, read_model
from sim_bridge.world import Body, World

DOCK_NAME = "dock"


def dock_bodies(dock_in_world: Pose2, name: str = DOCK_NAME) -> Tuple[Body, ...]:
    """Return the bodies of a dock's model.

    Args:
        dock_in_world: Pose of its front on the floor; the x axis points away from the dock.
        name: Name of the model.
    """
    text = (MODELS / "kobuki_dock/model.sdf").read_text(encoding="utf-8")
    return read_model(text, name, from_pose2(dock_in_world)).bodies


def with_dock(world: World, dock_in_world: Pose2, name: str = DOCK_NAME) -> World:
    """Return a world with a dock added.

    Args:
        world: The world.
        dock_in_world: Pose of the dock.
        name: Name of the dock's model.
    """
    return replace(world, bodies=(*world.bodies, *dock_bodies(dock_in_world, name)))
