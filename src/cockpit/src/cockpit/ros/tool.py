"""The contract of a tool, as those of rqt are: a window of the page with a subject of its own."""

import threading
from typing import Any, Callable, Protocol, Tuple

from cockpit.ros.graph import Graph
from planar import PlanarError


class Desk:
    """What a tool works with.

    ``gui``: viser's, whose controls come into the tool's window while it is built. ``graph``: the ROS graph.
    ``lock``: held while any of the tool's methods runs. ``words``: what a person has asked it to show, as in
    ``rqt_plot /odom/twist/twist/linear/x``; a tool may take no notice.
    """

    def __init__(
        self, gui: Any, graph: Graph, tell: Callable[[str, bool], None], words: Tuple[str, ...] = ()
    ):
        self.gui, self.graph, self.words = gui, graph, words
        self.lock = threading.RLock()
        self._tell = tell

    def tell(self, text: str, is_bad: bool = False) -> None:
        """A note on every page."""
        self._tell(text, is_bad)

    def guarded(self, do: Callable[[Any], None]) -> Callable[[Any], None]:
        """For what controls call, as ``button.on_click(desk.guarded(self._send))``.

        Controls call from threads of their own, whenever a person of any page acts. What is guarded has the
        tool for itself meanwhile; whatever it raises is told on the page, and is the end of this call only.
        """

        def guarded(event: Any) -> None:
            with self.lock:
                try:
                    do(event)
                except Exception as error:  # a person's input meets the whole of ROS here
                    self.tell(said(error), True)

        return guarded


class Tool(Protocol):
    """A window of the page that a person opens and closes.

    A tool is a module of ``cockpit/ros/tools`` that holds the class as ``TOOL``; nothing else has to know of
    it. What it computes is a pure module of ``cockpit/models``, tested without ROS and without a page.

    ``name``: by which ``cockpit.sh --tool`` and the page know it, one word; ``title``: of its window;
    ``seconds``: between two updates; ``width``: of its window, pixels.

    Life cycle: made when it is opened, with a desk of its own. ``build`` makes its controls, with
    ``desk.gui``, once; they vanish with the window. ``update`` is called every ``seconds`` while the window
    is open and a page is watched, ``close`` once at the end. ``pause`` is called when the last page closes:
    it ends every subscription, and the next ``update`` makes them anew.

    No method waits for another node for longer than a second: what takes longer gets a thread, and is shown
    by a later ``update``. Callbacks of ROS only hand over. Whatever a method raises is told on the page.
    """

    name: str
    title: str
    seconds: float
    width: int

    def __init__(self, desk: Desk): ...

    def build(self) -> None: ...

    def update(self, now: float) -> None:
        """``now``: seconds by a steady clock."""

    def pause(self) -> None: ...

    def close(self) -> None: ...


def said(error: Exception) -> str:
    """What went wrong, in one line."""
    text = " ".join(str(error).split())
    return text if isinstance(error, PlanarError) and text else f"{type(error).__name__}: {text}"[:300]
