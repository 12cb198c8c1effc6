"""The cockpit of a running graph: a thread that looks, draws and lets the tools work, ten times a second."""

import time
from html import escape
from typing import Callable

import rospy

from cockpit.errors import CockpitError
from cockpit.frames import FrameTree
from cockpit.page.drawer import Drawer
from cockpit.page.server import Page
from cockpit.page.view_panel import AUTOMATIC, ViewPanel
from cockpit.ros.graph import Graph
from cockpit.ros.showing import Layers
from cockpit.ros.toolbox import Toolbox
from cockpit.ros.transforms import TransformListener
from cockpit.ros.world import World

PERIOD = 0.1
# How often it is asked what there is.
LOOKING_SECONDS = 1.0
IDLE_SECONDS = 0.5
FIXED_FRAMES = ("map", "odom", "world")


class Cockpit:
    """Everything of the page but the page itself."""

    def __init__(self, page: Page):
        self._page = page
        self._graph = Graph()
        self._frames = FrameTree()
        self._transforms = TransformListener(self._frames)
        self._drawer = Drawer(page.scene)
        self._world = World(self._graph, page.scene, self._warn)
        tabs = page.gui.add_tab_group()
        cut = self._guarded(self._world.view.cut)
        self._view = ViewPanel(page.gui, tabs.add_tab("View"), cut)
        with tabs.add_tab("Tools"):
            self.toolbox = Toolbox(page, self._graph)
        self._world.view.cut(self._view.height.value)
        self._layers = Layers(self._graph, self._drawer, self._warn)
        self._look_at = 0.0
        self._fixed = ""
        self._trouble = ""

    def run(self, is_over: Callable[[], bool] = rospy.is_shutdown) -> None:
        """Until ``is_over``."""
        while not is_over():
            if not self._page.wait_for_someone(IDLE_SECONDS):
                self._rest()
                continue
            began = time.monotonic()
            self._turn(began)
            time.sleep(max(PERIOD - (time.monotonic() - began), 0.02))
        self._rest()

    def _rest(self) -> None:
        """Nobody looks: nothing is subscribed to."""
        self._layers.close()
        self._transforms.listen(False)
        self.toolbox.pause()

    def _turn(self, now: float) -> None:
        try:
            self._transforms.listen(True)
            if now >= self._look_at:
                self._look_at = now + LOOKING_SECONDS
                self._look_around()
            self._transforms.update()
            self._trouble = ""
        except CockpitError as error:
            self._trouble = str(error)
        self._choose_frame()
        self._layers.update(now)
        with self._page.atomic():
            self._world.update(self._frames, self._fixed, self._view.world.value, self._view.robots.value)
            self._drawer.place(self._frames, self._fixed)
        self.toolbox.update(now)
        self._view.tell(self._status())

    def _look_around(self) -> None:
        """What there is, and what of it is to be shown. Raises CockpitError."""
        offers = self._layers.offers()
        for topic, layer in offers.items():
            self._view.offer(topic, layer)
        for topic in set(self._view.offered()) - set(offers):
            self._view.withdraw(topic)
        self._layers.choose(self._view.offered(), offers)
        self._world.look_for()
        self._view.offer_frames(tuple(self._frames.names()))

    def _choose_frame(self) -> None:
        chosen = self._view.fixed.value
        if chosen == AUTOMATIC:
            known = set(self._frames.names())
            likely = [name for name in FIXED_FRAMES if name in known] or self._frames.roots() or ["map"]
            chosen = likely[0]
        self._fixed = chosen

    def _status(self) -> str:
        if self._trouble:
            return f'<div style="margin:0 12px;color:#c92a2a">{escape(self._trouble)}</div>'
        return f'<div style="margin:0 12px;opacity:.7">fixed frame <b>{escape(self._fixed)}</b></div>'

    def _warn(self, text: str) -> None:
        rospy.logwarn("%s", text)
        self._page.tell(text, True)

    def _guarded(self, do: Callable) -> Callable:
        """What a control calls: whatever it raises is told."""

        def guarded(*arguments: object) -> None:
            try:
                do(*arguments)
            except Exception as error:  # the end of this call only
                self._warn(f"{type(error).__name__}: {error}")

        return guarded
