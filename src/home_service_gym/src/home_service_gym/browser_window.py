"""Browser page of an environment: world, robot, scan and goal."""

import math
import time
from dataclasses import replace
from functools import partial
from html import escape
from pathlib import Path
from typing import Optional

import numpy as np

from cockpit.drawing import LayerUpdate, PlacedShape, PointCloudShape, TriangleMesh
from cockpit.frames import FrameTree, Transform
from cockpit.page.scene_renderer import SceneRenderer
from cockpit.page.server import Page
from cockpit.page.world_view import RobotView, WorldView
from cockpit.scene.reader import describe_bodies, describe_robot, robot_joints
from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState, lidar_profile
from home_service_gym.task import Overlay
from planar import Pose2
from sim_bridge import RobotProfile
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.people.crowd import body_of
from sim_bridge.sdf.includes import resolve

WORLD = "world"
SCAN, GOAL = (230, 57, 70), (60, 170, 80)
# Corners of a goal's disc, and its height above the floor [m].
CORNERS, DISC_HEIGHT = 32, 0.01


class BrowserWindow:
    """Serves the page and prints its URL.

    Args:
        robot: Robot profile.
        rate: Control rate [Hz], to which steps are slowed down while the page is open.
    """

    def __init__(self, robot: RobotProfile, rate: int):
        self._page = Page("127.0.0.1", 0)
        self._title = self._page.gui.add_html("")
        print(f"environment: {self._page.url}", flush=True)
        self._frames, self._scene_renderer = FrameTree(), SceneRenderer(self._page.scene)
        self._world = WorldView(self._page.scene)
        urdf, find_file = robot.description(), partial(resolve, beside=Path.cwd(), model_folders=())
        self._robot = RobotView(self._page.scene, "robot", describe_robot(urdf, find_file), "")
        for child, (parent, pose) in robot_joints(urdf).items():
            self._frames.put(child, Transform(parent, pose, 0.0, is_static=True))
        (self._base,) = self._frames.roots()
        self._simulation: Optional[EpisodeSimulation] = None
        self._scan_height = float(lidar_profile(robot).pose_in_base[2, 3])
        self._period, self._due = 1.0 / rate, 0.0

    def show(self, simulation: EpisodeSimulation, state: EpisodeState, overlay: Overlay) -> None:
        """Show a state; while a page is open, wait until its control period has passed."""
        with self._page.atomic():
            if simulation is not self._simulation:
                self._build(simulation)
            self._move(simulation, state, overlay)
        if self._page.is_watched:
            time.sleep(max(self._due - time.monotonic(), 0.0))
        self._due = time.monotonic() + self._period

    def close(self) -> None:
        self._page.close()

    def _build(self, simulation: EpisodeSimulation) -> None:
        for model in self._world.models:
            self._world.remove(model)
        world = simulation.arena.world
        description = describe_bodies(replace(world, bodies=(*world.bodies, *map(body_of, world.walkers))))
        corners = np.vstack([part.pose[:3, 3] for part in description.parts])[:, :2]
        self._world.show(description)
        self._page.frame_view(corners.min(axis=0), corners.max(axis=0))
        self._title.content = f"<b>{escape(simulation.arena.title)}</b>"
        self._simulation = simulation

    def _move(self, simulation: EpisodeSimulation, state: EpisodeState, overlay: Overlay) -> None:
        base = state.base_in_world
        self._frames.put(self._base, Transform(WORLD, _to_pose3(base), state.stamp, is_static=False))
        poses = {body.name: body.pose_in_world for body in simulation.arena.world.bodies}
        for trajectory in overlay.trajectories:
            height = poses[trajectory.link][2, 3]
            self._world.place(trajectory.link, pose3(*trajectory.at(state.stamp), height, 0.0, 0.0, 0.0))
        for walker, (x, y, *_) in zip(simulation.arena.world.walkers, state.people.tolist()):
            self._world.place(walker.link, pose3(x, y, walker.height / 2.0, 0.0, 0.0, 0.0))
        self._world.update(np.eye(4))
        self._robot.update(self._frames, WORLD, is_shown=True)
        hits = base.transform_points(state.scan.hit_points_in_base())
        points = np.column_stack([hits, np.full(len(hits), self._scan_height)])
        parts = [PlacedShape("scan", WORLD, PointCloudShape(points, SCAN, 0.05))]
        if overlay.goal is not None:
            parts.append(PlacedShape("goal", WORLD, _disc(*overlay.goal)))
        self._scene_renderer.show("episode", LayerUpdate(tuple(parts)))
        self._scene_renderer.place(self._frames, WORLD, time.monotonic())


def _to_pose3(pose: Pose2) -> np.ndarray:
    return pose3(pose.x, pose.y, 0.0, 0.0, 0.0, pose.yaw)


def _disc(at: Pose2, radius: float) -> TriangleMesh:
    angles = np.linspace(0.0, 2.0 * math.pi, CORNERS, endpoint=False)
    rim_xy = (at.x, at.y) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    vertices = np.column_stack([np.vstack([rim_xy, [(at.x, at.y)]]), np.full(CORNERS + 1, DISC_HEIGHT)])
    corners = np.arange(CORNERS)
    triangles = np.column_stack([np.full(CORNERS, CORNERS), corners, (corners + 1) % CORNERS])
    return TriangleMesh(vertices, triangles, GOAL, 0.6)
