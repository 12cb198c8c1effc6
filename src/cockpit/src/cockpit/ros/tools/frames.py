"""Frames: the tree of transforms with age and publisher (rqt_tf_tree)."""

from typing import Dict

import rospy

from cockpit.frames import FrameTree
from cockpit.models.frame_table import HEADS, rows_of
from cockpit.models.rates import RateMeter
from cockpit.models.tables import table
from cockpit.ros.tool import ToolContext
from cockpit.ros.transforms import TransformFeed


class FramesTool:
    name, title, seconds = "frames", "Frames (tf)", 0.5

    def __init__(self, context: ToolContext):
        self._context = context
        self._frames = FrameTree()
        self._listener = TransformFeed(self._frames)
        self._rates: Dict[str, RateMeter] = {}

    def build(self) -> None:
        self._tree = self._context.gui.add_html("")

    def update(self, now: float) -> None:
        self._listener.subscribe(True)
        self._listener.update()
        transforms = self._frames.transforms()
        rates = {}
        for frame in transforms:
            rate = self._rates.setdefault(frame, RateMeter())
            rates[frame], _ = rate.update(now, self._listener.counts[frame], 0)
        rows = rows_of(transforms, rospy.get_time(), rates)
        self._tree.content = table(HEADS, rows) if rows else table(("No transforms on /tf yet.",), ())

    def pause(self) -> None:
        self._listener.subscribe(False)
        self._frames.clear()
        self._rates.clear()

    close = pause


TOOL = FramesTool
