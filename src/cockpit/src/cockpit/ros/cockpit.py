"""The cockpit of a running graph: one thread that reads topics, draws and updates tools at 10 Hz."""

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
from cockpit.page.style import sheet_html
from cockpit.page.toolbar import Toolbar
from cockpit.page.view_panel import AUTOMATIC, ViewPanel
from cockpit.ros.drive_tab import DriveTab
from cockpit.ros.graph import GraphClient
from cockpit.ros.home_tab import HomeTab
from cockpit.ros.layer_subscriptions import LayerManager
from cockpit.ros.log_collector import LogCollector
from cockpit.ros.tool import error_text
from cockpit.ros.toolbox import Toolbox
from cockpit.ros.transforms import TransformFeed
from cockpit.ros.world.scene_reader import SceneReader
from cockpit.ros.world.world import WorldTracker

PERIOD = 0.1
# Period of looking for new topics, worlds and robots [s].
REFRESH_SECONDS = 1.0
IDLE_SECONDS = 0.5
FIXED_FRAMES = ("map", "odom", "world")
FRAMES = "frames"
# A larger jump back of ROS time is a restart [s].
JITTER_SECONDS = 0.1


class CockpitController:
    """Connects the page to the ROS graph.

    Args:
        page: The page.
        reader: Reads worlds and robots in child processes.
    """

    def __init__(self, page: Page, reader: SceneReader):
        self._page = page
        self._graph = GraphClient()
        self._log = LogCollector(self._graph)
        self._fixed: str = FIXED_FRAMES[0]
        self._frames = FrameTree()
        self._transforms = TransformFeed(self._frames)
        self._drawer = SceneRenderer(page.scene)
        self._world = WorldTracker(self._graph, page.scene, reader, self._warn)
        pointer = FloorPointer(page.floor, self._drawer)
        self._drive_tab = DriveTab(
            self._graph, self._frames, pointer, self._world, page.notify, lambda: self._fixed
        )
        self._home_tab = HomeTab(self._graph, page.origin)
        self._build()
        self._world.view.cut(self._view.height.value)
        self._layers = LayerManager(self._graph, self._drawer, self._warn)
        self._follower = CameraFollower(page)
        page.on_leave(self._drive_tab.teleop.release)
        self._refresh_at = self._newest = 0.0
        self._error = self._last_warning = ""

    def _build(self) -> None:
        gui = self._page.gui
        gui.add_html(sheet_html())
        toolbar = Toolbar(gui, self._drive_tab.set_mode, self._guarded)
        tabs = gui.add_tab_group()
        self._view = ViewPanel(gui, tabs.add_tab("View"), self._guarded(self._world.view.cut))
        self._drive_tab.build(gui, tabs.add_tab("Drive"), toolbar, self._guarded)
        with tabs.add_tab("Tools"):
            self.toolbox = Toolbox(self._page, self._graph, self._log.entries)
        self._home_tab.build(gui, tabs.add_tab("Home"), self._guarded)
        self._screens = CameraWindow(gui, self._page.windows)

    def run(self, is_over: Callable[[], bool] = rospy.is_shutdown) -> None:
        """Run until ``is_over`` returns True."""
        while not is_over():
            if not self._page.wait_for_client(IDLE_SECONDS):
                self._unsubscribe()
                self._prepare()
                continue
            began = time.monotonic()
            try:
                self._step(began)
            except Exception as error:  # malformed data from the graph must not end the page
                self._warn_once(error_text(error))
            time.sleep(max(PERIOD - (time.monotonic() - began), 0.02))
        self._drive_tab.teleop.close()
        self._home_tab.close()
        self._unsubscribe()

    def _prepare(self) -> None:
        """Read the world early, for the first client, and store what is logged."""
        with suppress(CockpitError):
            self._log.update()
            self._world.poll()

    def _unsubscribe(self) -> None:
        """End all subscriptions but the log's while no page is open."""
        self._layers.close()
        self._transforms.subscribe(False)
        self._drive_tab.unsubscribe()
        self._world.unsubscribe()
        self.toolbox.pause()

    def _step(self, now: float) -> None:
        self._check_time(rospy.get_time())
        try:
            self._transforms.subscribe(True)
            if now >= self._refresh_at:
                self._refresh_at = now + REFRESH_SECONDS
                self._refresh()
            self._drive_tab.update()
            self._transforms.update()
            self._log.update()
            self._error = ""
        except Exception as error:  # everything else is still drawn
            self._error = error_text(error)
        self._fixed = self._fixed_frame()
        self._layers.update(now)
        self._show(now)
        self.toolbox.update(now)
        try:
            self._home_tab.update()
        except CockpitError as error:
            self._warn(str(error))

    def _check_time(self, stamp: float) -> None:
        """Reset layers and frames if ROS time [s] has jumped back."""
        if stamp < self._newest - JITTER_SECONDS:
            self._layers.reset()
            self._frames.reset()
        self._newest = stamp

    def _refresh(self) -> None:
        """Update the lists of topics, worlds and frames. Raises CockpitError."""
        offers = self._layers.offers()
        for topic, layer in offers.items():
            self._view.offer(topic, layer)
        for topic in set(self._view.offered()) - set(offers):
            self._view.withdraw(topic)
        self._layers.choose(self._view.offered(), offers)
        self._world.poll()
        self._view.offer_frames(tuple(self._frames.names()))
        self._drive_tab.refresh()
        self._home_tab.refresh()

    def _fixed_frame(self) -> str:
        """Return the selected fixed frame or a default."""
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
        base = self._drive_tab.base_frame() if view.follow.value else None
        self._follower.update(None if base is None else self._frames.pose(base, fixed))
        self._screens.show(self._layers.screens)
        view.show_status(self._status())

    def _status(self) -> str:
        if self._error:
            return f'<div style="margin:0 12px;color:#c92a2a">{escape(self._error)}</div>'
        return f'<div style="margin:0 12px;opacity:.7">fixed frame <b>{escape(self._fixed)}</b></div>'

    def _warn_once(self, text: str) -> None:
        """Report an error once until it changes."""
        if text != self._last_warning:
            self._last_warning = text
            self._warn(text)

    def _warn(self, text: str) -> None:
        rospy.logwarn("%s", text)
        self._page.notify(text, True)

    def _guarded(self, do: Callable[[Any], object]) -> Callable[[Any], None]:
        """Wrap a callback of a control so that its exceptions are reported."""

        def guarded(event: Any) -> None:
            try:
                do(event)
            except Exception as error:  # user input can raise any error of ROS
                self._warn(error_text(error))

        return guarded


def frames_drawn(frames: FrameTree, fixed: str) -> LayerUpdate:
    """Draw the axes and names of all frames that are connected to the fixed frame.

    Args:
        frames: Tree of frames.
        fixed: Fixed frame.
    """
    found = [(name, frames.pose(name, fixed)) for name in frames.names()]
    poses = [(name, pose) for name, pose in found if pose is not None]
    if not poses:
        return LayerUpdate()
    labels = [PlacedShape(name, fixed, Label(name, np.zeros(3)), pose) for name, pose in poses]
    axes = PlacedShape("axes", fixed, FrameAxes(np.array([pose for _, pose in poses])))
    return LayerUpdate((axes, *labels))
