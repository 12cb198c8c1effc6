"""Frames: the tree of transforms, how old each is, and who tells it (rqt_tf_tree)."""

from typing import Dict

import rospy

from cockpit.frames import FrameTree
from cockpit.models.rates import Rate
from cockpit.models.tables import table
from cockpit.models.tree import HEADS, rows_of
from cockpit.ros.tool import Desk
from cockpit.ros.transforms import TransformListener


class Frames:
    name, title, seconds, width = "frames", "Frames (tf)", 0.5, 520

    def __init__(self, desk: Desk):
        self._desk = desk
        self._frames = FrameTree()
        self._listener = TransformListener(self._frames)
        self._rates: Dict[str, Rate] = {}

    def build(self) -> None:
        self._tree = self._desk.gui.add_html("")

    def update(self, now: float) -> None:
        self._listener.listen(True)
        self._listener.update()
        transforms = self._frames.transforms()
        rates = {}
        for frame in transforms:
            rate = self._rates.setdefault(frame, Rate())
            rates[frame], _ = rate.update(now, self._listener.counts[frame], 0)
        rows = rows_of(transforms, rospy.get_time(), rates)
        self._tree.content = table(HEADS, rows) if rows else table(("Nobody tells of frames on /tf.",), ())

    def pause(self) -> None:
        self._listener.listen(False)
        self._frames.clear()
        self._rates.clear()

    close = pause


TOOL = Frames
