"""Reads <actor> elements: pedestrians, as cylinders that follow their trajectory."""

from typing import List, Optional, Tuple

import numpy as np

from sim_bridge.geometry.pose3 import IDENTITY, pose3
from sim_bridge.geometry.shapes import Cylinder
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.supported import REDUNDANT_PLUGINS, plugin_name
from sim_bridge.sdf.warnings import SkippedElements
from sim_bridge.world import Body, Collision

# Size of an actor [m], about that of Gazebo's skins.
RADIUS, HEIGHT = 0.25, 1.7
# Time that an actor stays at its last waypoint if its trajectory is not a loop [s].
STAY = 1e9


def read_actor(actor: Element, warnings: SkippedElements) -> Tuple[Body, Optional[ScriptedTrajectory]]:
    """Read an <actor>: a cylinder that follows the actor's trajectory.

    Args:
        actor: The element.
        warnings: Receives warnings about ignored plugins and elements.

    Returns:
        The body, and its trajectory; None if it does not move.

    Raises:
        WorldError: A value is not valid.
    """
    for plugin in actor.children("plugin"):
        if plugin_name(plugin) not in REDUNDANT_PLUGINS:
            warnings.skip(plugin, "ignored, the actor moves by its trajectory alone")
    link = f"{actor.name}::link"
    trajectory = _trajectory(actor, link)
    own_pose = actor.raw_pose()
    x, y = trajectory.at(0.0) if trajectory else ((0.0, 0.0) if own_pose is None else own_pose[:2, 3])
    solid = Collision(Cylinder(RADIUS, HEIGHT), IDENTITY)
    pose = pose3(x, y, HEIGHT / 2.0)
    return Body(link, pose, (solid,), is_kinematic=trajectory is not None), trajectory


def _trajectory(actor: Element, link: str) -> Optional[ScriptedTrajectory]:
    script, trajectory = actor.child("script"), actor.child("script", "trajectory")
    waypoints = [] if trajectory is None else list(trajectory.children("waypoint"))
    if script is None or not waypoints:
        return None
    delay = max(script.number("delay_start", default=0.0), 0.0)
    keyframes: List[Tuple[float, float, float]] = []
    for waypoint in waypoints:
        pose = waypoint.raw_pose()
        if pose is None:
            raise waypoint.error("<pose> is missing")
        keyframes.append((delay + waypoint.required("time").numbers(1)[0], pose[0, 3], pose[1, 3]))
    keyframes.sort(key=lambda keyframe: keyframe[0])
    if keyframes[0][0] > 0.0:
        keyframes.insert(0, (0.0, *keyframes[0][1:]))
    is_repeated = script.child("loop") is None or script.flag("loop")
    if len(keyframes) == 1 or not is_repeated:
        keyframes.append((keyframes[-1][0] + STAY, *keyframes[-1][1:]))
    times, *points = np.array(keyframes).T
    return ScriptedTrajectory(link, times, np.column_stack(points))
