"""The contract of a tool: a window of the page, like one plugin of rqt."""

import threading
from typing import Any, Callable, Protocol, Tuple

from cockpit.models.log import LogBuffer
from cockpit.ros.graph import GraphClient
from planar import PlanarError
from planar.deprecation import renamed_method


class ToolContext:
    """The page, the ROS graph, the log, a lock and the arguments of a tool.

    Args:
        gui: The gui of viser.
        graph: Client of the ROS graph.
        notify: Shows a notification on the page; called with the text and whether it reports an error.
        log: The log messages since the cockpit was started.
        words: Arguments of the command line.

    Attributes:
        gui: The gui of viser; controls made during ``Tool.build`` appear in the tool's window.
        graph: Client of the ROS graph.
        log: The log messages of all nodes since the cockpit was started.
        lock: Held while any method of the tool runs.
        words: Arguments of the command line, as in ``rqt_plot /odom/twist/twist/linear/x``; may be ignored.
    """

    def __init__(
        self,
        gui: Any,
        graph: GraphClient,
        notify: Callable[[str, bool], None],
        log: LogBuffer,
        words: Tuple[str, ...] = (),
    ):
        self.gui, self.graph, self.log, self.words = gui, graph, log, words
        self.lock = threading.RLock()
        self._notify = notify

    def notify(self, text: str, is_bad: bool = False) -> None:
        """Show a notification on every open page.

        Args:
            text: The notification.
            is_bad: Whether it reports an error.
        """
        self._notify(text, is_bad)

    tell = renamed_method("tell", "notify")

    def guarded(self, do: Callable[[Any], None]) -> Callable[[Any], None]:
        """Wrap a callback of a control: ``button.on_click(context.guarded(self._send))``.

        viser calls back from other threads. The wrapper holds the tool's lock during the call and reports any
        exception on the page.
        """

        def guarded(event: Any) -> None:
            with self.lock:
                try:
                    do(event)
                except Exception as error:  # a person's input meets the whole of ROS here
                    self.notify(error_text(error), True)

        return guarded


class Tool(Protocol):
    """A window of the page that can be opened and closed.

    A tool is a module of ``cockpit/ros/tools`` that defines the class as ``TOOL``; it is found automatically.
    Computations belong in a module of ``cockpit/models``, tested without ROS and without a page.

    Life cycle: created with a context when it is opened. ``build`` is called once and creates the controls
    with ``context.gui``; they are removed with the window. ``update`` is called every ``seconds`` while the
    window and at least one page are open, ``close`` once at the end. ``pause`` is called when the last page
    closes: it ends all subscriptions; the next ``update`` makes them again.

    No method may block for more than a second: longer work runs in a BackgroundCall, and a later ``update``
    shows its result. ROS callbacks only store messages. An exception of any method is reported on the page.

    Attributes:
        name: Identifier for ``cockpit.sh --tool`` and the page, one word.
        title: Title of the window.
        seconds: Time between two updates [s].
    """

    name: str
    title: str
    seconds: float

    def __init__(self, context: ToolContext): ...

    def build(self) -> None: ...

    def update(self, now: float) -> None:
        """Refresh the window.

        Args:
            now: Steady-clock time [s].
        """

    def pause(self) -> None: ...

    def close(self) -> None: ...


def error_text(error: Exception) -> str:
    """Format an error as one line."""
    text = " ".join(str(error).split())
    return text if isinstance(error, PlanarError) and text else f"{type(error).__name__}: {text}"[:300]
