"""The open tools."""

import threading
from dataclasses import dataclass
from typing import Any, Dict, List, Tuple

from cockpit.models.log import LogBuffer
from cockpit.page.server import Page
from cockpit.page.tool_panel import ToolPanel
from cockpit.ros.graph import GraphClient
from cockpit.ros.tool import Tool, ToolContext, error_text
from cockpit.ros.tools import all_tools


@dataclass
class _OpenTool:
    tool: Tool
    context: ToolContext
    window: Any
    due: float = 0.0
    complaint: str = ""


class Toolbox:
    """Opens, closes and updates tools.

    Args:
        page: The page.
        graph: Client of the ROS graph.
        log: The log messages since the cockpit was started.
    """

    def __init__(self, page: Page, graph: GraphClient, log: LogBuffer):
        self._page, self._graph, self._log = page, graph, log
        self._kinds = all_tools()
        self._open: Dict[str, _OpenTool] = {}
        self._words: Dict[str, Tuple[str, ...]] = {}
        self._lock = threading.RLock()
        titles = [(name, kind.title) for name, kind in self._kinds.items()]
        self._panel = ToolPanel(page.gui, titles, self._switch)

    @property
    def names(self) -> List[str]:
        return list(self._kinds)

    def open(self, name: str, words: Tuple[str, ...] = ()) -> None:
        """Open a tool.

        Args:
            name: Name of the tool.
            words: Arguments of the command line for the tool.
        """
        self._words[name] = words
        self._panel.open(name)

    def update(self, now: float) -> None:
        for name, opened in self._opened():
            if now < opened.due or not opened.context.lock.acquire(blocking=False):
                continue  # a callback holds the tool: update it later
            opened.due = now + opened.tool.seconds
            try:
                if name in self._open:
                    opened.tool.update(now)
                opened.complaint = ""
            except Exception as error:  # data from the graph may be malformed in any way
                self._complain(opened, error)
            finally:
                opened.context.lock.release()

    def pause(self) -> None:
        for _, opened in self._opened():
            with opened.context.lock:
                opened.tool.pause()

    def close(self) -> None:
        for name, _ in self._opened():
            self._switch(name, False)

    def _opened(self):
        with self._lock:
            return list(self._open.items())

    def _switch(self, name: str, is_on: bool) -> None:
        with self._lock:
            if is_on and name not in self._open:
                self._open[name] = self._make(name)
            elif not is_on and name in self._open:
                opened = self._open.pop(name)
                with opened.context.lock:
                    opened.tool.close()
                self._page.windows.remove(opened.window)

    def _make(self, name: str) -> _OpenTool:
        kind = self._kinds[name]
        words = self._words.pop(name, ())
        context = ToolContext(self._page.gui, self._graph, self._page.notify, self._log, words)
        window = self._page.windows.open(kind.title)
        opened = _OpenTool(kind(context), context, window)
        with context.lock, self._page.atomic(), window:  # a click must not meet a part of it
            opened.tool.build()
        return opened

    def _complain(self, opened: _OpenTool, error: Exception) -> None:
        """Report an error once until it changes."""
        text = f"{opened.tool.title}: {error_text(error)}"
        if text != opened.complaint:
            self._page.notify(text, True)
        opened.complaint = text
