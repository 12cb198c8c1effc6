"""Print what the nodes log, as far as people want to read it."""

import re
from typing import Callable, Set

from evaluation.event_stream import EventStream
from evaluation.events import LineLogged

NUMBER = re.compile(r"\d[\d.]*")
# Nodes whose information is printed; of the others only warnings are.
PRINTED_NODES = ("pick_objects", "add_markers")


class LogPrinter:
    """Prints warnings and the progress of the mission.

    Args:
        log: Called with each line.
    """

    def __init__(self, log: Callable[[str], None]):
        self._log = log
        self._printed: Set[str] = set()

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(LineLogged, self._on_line)

    def _on_line(self, event: LineLogged) -> None:
        if event.is_warning:
            # Numbers aside, a warning is printed once; the report lists all of them.
            gist = f"{event.node}: {NUMBER.sub('', event.text)}"
            if gist not in self._printed:
                self._log(f"{event.node}: warning: {event.text}")
            self._printed.add(gist)
        elif event.node in PRINTED_NODES:
            self._log(f"{event.node}: {event.text}")
