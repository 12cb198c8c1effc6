"""The cockpit of a running graph: a thread that looks, draws and lets the tools work, ten times a second."""

import time
from contextlib import suppress
from html import escape
from typing import Any, Callable

import numpy as np
import rospy

from cockpit.drawing import FrameAxes, Label, LayerUpdate, PlacedShape
from cockpit.errors import CockpitError
from cockpit.frames import FrameTree
from cockpit.page.camera_follower import CameraFollower
from cockpit.page.camera_images import CameraWindow
from cockpit.page.pointer import FloorPointer
from cockpit.page.scene_renderer import SceneRenderer
from cockpit.page.server import Page
from cockpit.page.view_panel import AUTOMATIC, ViewPanel
from cockpit.ros.drive_tab import DriveTab
from cockpit.ros.graph import GraphClient
from cockpit.ros.layer_subscriptions import LayerManager
from cockpit.ros.tool import error_text
from cockpit.ros.toolbox import Toolbox
from cockpit.ros.transforms import TransformFeed
from cockpit.ros.world.scene_reader import SceneReader
from cockpit.ros.world.world import WorldTracker

PERIOD = 0.1
# How often it is asked what there is.
LOOKING_SECONDS = 1.0
IDLE_SECONDS = 0.5
FIXED_FRAMES = ("map", "odom", "world")
FRAMES = "frames"
# Time that jumps back further has begun anew.
JITTER_SECONDS = 0.1


class Cockpit:
    """Everything of the page but the page itself."""

    def __init__(self, page: Page, reader: SceneReader):
        self._page = page
        self._graph = GraphClient()
        self._fixed: str = FIXED_FRAMES[0]
        self._frames = FrameTree()
        self._transforms = TransformFeed(self._frames)
        self._drawer = SceneRenderer(page.scene)
        self._world = WorldTracker(self._graph, page.scene, reader, self._warn)
        pointer = FloorPointer(page.floor, self._drawer)
        self._driving = DriveTab(
            self._graph, self._frames, pointer, self._world, page.notify, lambda: self._fixed
        )
        self._build()
        self._world.view.cut(self._view.height.value)
        self._layers = LayerManager(self._graph, self._drawer, self._warn)
        self._follower = CameraFollower(page)
        page.on_leave(self._driving.teleop.release)
        self._look_at = self._newest = 0.0
        self._trouble = self._complaint = ""

    def _build(self) -> None:
        gui = self._page.gui
        tabs = gui.add_tab_group()
        self._view = ViewPanel(gui, tabs.add_tab("View"), self._guarded(self._world.view.cut))
        self._driving.build(gui, tabs.add_tab("Drive"), self._guarded)
        with tabs.add_tab("Tools"):
            self.toolbox = Toolbox(self._page, self._graph)
        self._screens = CameraWindow(gui)

    def run(self, is_over: Callable[[], bool] = rospy.is_shutdown) -> None:
        """Until ``is_over``."""
        while not is_over():
            if not self._page.wait_for_someone(IDLE_SECONDS):
                self._rest()
                self._read_world()
                continue
            began = time.monotonic()
            try:
                self._turn(began)
            except Exception as error:  # whatever a graph sends, the page goes on
                self._complain(error_text(error))
            time.sleep(max(PERIOD - (time.monotonic() - began), 0.02))
        self._driving.teleop.close()
        self._rest()

    def _read_world(self) -> None:
        """So that it is there when the first page opens."""
        with suppress(CockpitError):
            self._world.poll()

    def _rest(self) -> None:
        """Nobody looks: nothing is subscribed to."""
        self._layers.close()
        self._transforms.listen(False)
        self._driving.rest()
        self._world.rest()
        self.toolbox.pause()

    def _turn(self, now: float) -> None:
        self._watch_time(rospy.get_time())
        try:
            self._transforms.listen(True)
            if now >= self._look_at:
                self._look_at = now + LOOKING_SECONDS
                self._refresh()
            self._driving.update()
            self._transforms.update()
            self._trouble = ""
        except Exception as error:  # the rest is shown nevertheless
            self._trouble = error_text(error)
        self._fixed = self._fixed_frame()
        self._layers.update(now)
        self._show(now)
        self.toolbox.update(now)

    def _watch_time(self, stamp: float) -> None:
        """``stamp``: seconds of ROS time."""
        if stamp < self._newest - JITTER_SECONDS:
            self._layers.reset()
            self._frames.reset()
        self._newest = stamp

    def _refresh(self) -> None:
        """What there is, and what of it is to be shown. Raises CockpitError."""
        offers = self._layers.offers()
        for topic, layer in offers.items():
            self._view.offer(topic, layer)
        for topic in set(self._view.offered()) - set(offers):
            self._view.withdraw(topic)
        self._layers.choose(self._view.offered(), offers)
        self._world.poll()
        self._view.offer_frames(tuple(self._frames.names()))
        self._driving.refresh()

    def _fixed_frame(self) -> str:
        """The one that was chosen, or the likeliest."""
        if self._view.fixed.value != AUTOMATIC:
            return self._view.fixed.value
        known = set(self._frames.names())
        return next(iter([name for name in FIXED_FRAMES if name in known] or self._frames.roots()), "map")

    def _show(self, now: float) -> None:
        view, fixed = self._view, self._fixed
        with self._page.atomic():
            if view.frames.value:
                self._drawer.show(FRAMES, frames_drawn(self._frames, fixed))
            else:
                self._drawer.clear(FRAMES)
            self._world.update(self._frames, fixed, view.world.value, view.robots.value)
            self._drawer.place(self._frames, fixed, now)
        base = self._driving.base_frame() if view.follow.value else None
        self._follower.update(None if base is None else self._frames.pose(base, fixed))
        self._screens.show(self._layers.screens)
        view.show_status(self._status())

    def _status(self) -> str:
        if self._trouble:
            return f'<div style="margin:0 12px;color:#c92a2a">{escape(self._trouble)}</div>'
        return f'<div style="margin:0 12px;opacity:.7">fixed frame <b>{escape(self._fixed)}</b></div>'

    def _complain(self, text: str) -> None:
        """Once for each thing that is wrong."""
        if text != self._complaint:
            self._complaint = text
            self._warn(text)

    def _warn(self, text: str) -> None:
        rospy.logwarn("%s", text)
        self._page.notify(text, True)

    def _guarded(self, do: Callable[[Any], object]) -> Callable[[Any], None]:
        """For what controls call: whatever it raises is told, and is the end of this call only."""

        def guarded(event: Any) -> None:
            try:
                do(event)
            except Exception as error:  # a person's input meets the whole of ROS here
                self._warn(error_text(error))

        return guarded


def frames_drawn(frames: FrameTree, fixed: str) -> LayerUpdate:
    """The axes of every frame that is joined to the fixed one, with their names."""
    found = [(name, frames.pose(name, fixed)) for name in frames.names()]
    poses = [(name, pose) for name, pose in found if pose is not None]
    if not poses:
        return LayerUpdate()
    labels = [PlacedShape(name, fixed, Label(name, np.zeros(3)), pose) for name, pose in poses]
    axes = PlacedShape("axes", fixed, FrameAxes(np.array([pose for _, pose in poses])))
    return LayerUpdate((axes, *labels))
