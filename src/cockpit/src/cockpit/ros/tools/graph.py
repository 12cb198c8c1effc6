"""Graph: nodes and topics, drawn by graphviz (rqt_graph)."""

import re
import subprocess

from cockpit.errors import CockpitError
from cockpit.models.computation import ACTIVE, KINDS, Shown, dot_of
from cockpit.ros.aside import Aside
from cockpit.ros.tool import Desk

DRAWING_SECONDS = 10.0
SIZE = re.compile(r'<svg width="(\d+)[^"]*" height="[^"]*"')


class Graph:
    name, title, seconds, width = "graph", "Graph", 1.0, 640

    def __init__(self, desk: Desk):
        self._desk = desk
        self._aside = Aside()
        self._drawn = ""

    def build(self) -> None:
        gui = self._desk.gui
        self._kind = gui.add_dropdown("Show", KINDS, initial_value=ACTIVE)
        self._part = gui.add_text("Filter", "", hint="part of a name")
        self._debug = gui.add_checkbox("Debug", False, hint="the log, the clock, the cockpit itself")
        self._transforms = gui.add_checkbox("/tf", False)
        self._actions = gui.add_checkbox("Topics of actions apart", False)
        self._picture = gui.add_html("")

    def update(self, now: float) -> None:
        for picture in self._aside.take():
            self._picture.content = picture
        shown = Shown(
            self._kind.value,
            self._debug.value,
            self._transforms.value,
            self._actions.value,
            self._part.value,
        )
        graph = self._desk.graph
        dot = dot_of(graph.publishers(), graph.subscribers(), shown)
        if dot != self._drawn and not self._aside.is_busy:
            self._drawn = dot
            self._aside.start(lambda: _html(dot))

    def pause(self) -> None:
        """It listens to nothing."""

    close = pause


def _html(dot: str) -> str:
    """Raises CockpitError."""
    try:
        done = subprocess.run(
            ["dot", "-Tsvg"], input=dot.encode(), capture_output=True, timeout=DRAWING_SECONDS, check=True
        )
    except FileNotFoundError:
        raise CockpitError("graphviz is not installed: ./scripts/setup.sh --web brings it") from None
    except subprocess.SubprocessError:
        raise CockpitError("graphviz could not draw the graph; a filter makes it smaller") from None
    svg = done.stdout.decode(errors="replace")
    svg = SIZE.sub(r'<svg style="width:100%;max-width:\1px;height:auto"', svg[svg.index("<svg") :])
    return f'<div style="overflow:auto;max-height:70vh;margin:0 12px">{svg}</div>'


TOOL = Graph
