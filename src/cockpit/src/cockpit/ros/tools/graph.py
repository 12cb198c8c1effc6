"""Graph: nodes and topics, drawn by graphviz (rqt_graph)."""

import re
import subprocess

from cockpit.errors import CockpitError
from cockpit.models.graph_drawing import ACTIVE, KINDS, GraphFilter, dot_of
from cockpit.ros.background import BackgroundCall
from cockpit.ros.tool import ToolContext

DRAWING_SECONDS = 10.0
SIZE = re.compile(r'<svg width="(\d+)[^"]*" height="[^"]*"')


class GraphTool:
    name, title, seconds = "graph", "Graph", 1.0

    def __init__(self, context: ToolContext):
        self._context = context
        self._background = BackgroundCall()
        self._drawn = ""

    def build(self) -> None:
        gui = self._context.gui
        self._kind = gui.add_dropdown("Show", KINDS, initial_value=ACTIVE)
        self._part = gui.add_text("Filter", "", hint="part of a name")
        self._debug = gui.add_checkbox("Debug", False, hint="the log, the clock, the cockpit itself")
        self._transforms = gui.add_checkbox("/tf", False)
        self._actions = gui.add_checkbox("Action topics separately", False)
        self._picture = gui.add_html("")

    def update(self, now: float) -> None:
        for picture in self._background.results():
            self._picture.content = picture
        shown = GraphFilter(
            self._kind.value,
            self._debug.value,
            self._transforms.value,
            self._actions.value,
            self._part.value,
        )
        graph = self._context.graph
        dot = dot_of(graph.publishers(), graph.subscribers(), shown)
        if dot != self._drawn and not self._background.is_busy:
            self._drawn = dot
            self._background.start(lambda: _html(dot))

    def pause(self) -> None:
        """Nothing to do: the tool has no subscriptions."""

    close = pause


def _html(dot: str) -> str:
    """Raises CockpitError."""
    try:
        done = subprocess.run(
            ["dot", "-Tsvg"], input=dot.encode(), capture_output=True, timeout=DRAWING_SECONDS, check=True
        )
    except FileNotFoundError:
        raise CockpitError("graphviz is not installed; run ./scripts/setup.sh --web") from None
    except subprocess.SubprocessError:
        raise CockpitError("graphviz could not draw the graph; use the filter to make it smaller") from None
    svg = done.stdout.decode(errors="replace")
    svg = SIZE.sub(r'<svg style="width:100%;max-width:\1px;height:auto"', svg[svg.index("<svg") :])
    return f'<div style="overflow:auto;max-height:70vh;margin:0 12px">{svg}</div>'


TOOL = GraphTool
