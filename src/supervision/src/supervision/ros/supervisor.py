"""Supervision of a graph: start it, watch it until its work is done, end it."""

import threading
import time
from concurrent.futures import Future
from pathlib import Path
from typing import Callable, Collection, List, Mapping, Optional

from supervision.display import Display
from supervision.errors import LaunchError
from supervision.interruption import raise_if_interrupted
from supervision.node_exits import Restart
from supervision.processes import end_descendants
from supervision.ros.graph import RosGraph
from supervision.ros.node_api import unresponsive_nodes

POLL_SECONDS = 0.05
BRING_UP_SECONDS = 60.0


class Supervisor:
    """Starts a graph, waits for its parts, and detects when it cannot continue; Ctrl-C is handled meanwhile.

    Args:
        display: Terminal output.
        log_folder: Folder of the logs.
        time_limit: Wall-clock time from now after which ``watch`` fails [s].
    """

    def __init__(self, display: Display, log_folder: Path, time_limit: float):
        self._display, self._log_folder, self._time_limit = display, log_folder, time_limit
        self._deadline = time.monotonic() + time_limit
        self._graph: Optional[RosGraph] = None
        self._restarts_shown = 0
        self._work: Optional[Future] = None

    def start(
        self,
        package: str,
        launch_file: str,
        arguments: Mapping[str, object],
        respawned: Collection[str] = (),
    ) -> None:
        """Launch the graph.

        Raises:
            LaunchError: If it cannot be launched.
        """
        self._graph = RosGraph(package, launch_file, arguments, self._log_folder, respawned)

    def wait_for(self, what: str, is_there: Callable[[], bool]) -> None:
        """Wait for a part of the graph.

        Args:
            what: Name of the part in messages.
            is_there: Whether it is available.

        Raises:
            LaunchError: If it does not become available.
        """
        deadline = time.monotonic() + BRING_UP_SECONDS
        while not is_there():
            failure = self._failure(f" before {what} was there")
            if failure is None and time.monotonic() > deadline:
                failure = f"no {what} within {BRING_UP_SECONDS:g} s, see {self._log_folder}"
            if failure:
                raise LaunchError(failure)
            self._display.show(f"waiting for {what}")
            time.sleep(POLL_SECONDS)

    def run_in_thread(self, what: str, work: Callable[[], object]) -> None:
        """Run ``work`` in a thread, since calls to a dead master may block for ever.

        Args:
            what: Name of the work in messages.
            work: Function; an OSError in it means that the master has died.

        Raises:
            LaunchError: If the graph ends before the work is done.
        """
        working = self._work = Future()

        def do():
            try:
                working.set_result(work())
            except OSError:
                pass  # the failure of the graph explains it
            except Exception as error:
                working.set_exception(error)

        threading.Thread(target=do, daemon=True).start()
        self.wait_for(what, working.done)
        working.result()

    @property
    def has_pending_work(self) -> bool:
        """Whether work in a thread has not ended, and never will."""
        return self._work is not None and not self._work.done()

    def watch(self, is_over: Callable[[], bool], status: Callable[[], str]) -> Optional[str]:
        """Show the status until ``is_over``.

        Returns:
            Why it cannot be reached, or None once it is.
        """
        while not is_over():
            failure = self._failure()
            if failure is None and time.monotonic() > self._deadline:
                silent = _describe_unresponsive_nodes()
                failure = f"not done within {self._time_limit:g} s of wall-clock time{silent}"
            if failure:
                return failure
            self._display.show(status())
            time.sleep(POLL_SECONDS)
        return None

    def end(self) -> None:
        """End every process of the graph, also if its start was interrupted."""
        if self._graph is not None:
            self._graph.close()
        else:
            end_descendants()

    @property
    def end_of_graph(self) -> Optional[str]:
        """Why the graph has ended, or None; also after Ctrl-C. Raises LaunchError as ``watch`` does."""
        is_running = self._graph is not None and self._graph.is_running
        return None if is_running else self._failure_of_graph()

    @property
    def log_gap(self) -> Optional[str]:
        """Why the graph's log is incomplete; None if it is complete."""
        return None if self._graph is None else self._graph.log_gap

    @property
    def restarts(self) -> List[Restart]:
        """Nodes that died and were restarted."""
        return [] if self._graph is None else self._graph.exits.restarts

    def _show_restarts(self) -> None:
        for restart in self.restarts[self._restarts_shown :]:
            self._display.print(f"{restart.node}: {restart.reason}, restarted")
            self._restarts_shown += 1

    def _failure(self, when: str = "") -> Optional[str]:
        """Return why the graph cannot continue; raises LaunchError if a node rejected its input."""
        raise_if_interrupted()
        return self._failure_of_graph(when)

    def _failure_of_graph(self, when: str = "") -> Optional[str]:
        assert self._graph is not None, "start() comes first"
        self._show_restarts()
        failure = self._graph.exits.failure
        if failure is not None and failure.is_bad_input:
            raise LaunchError(failure.text, is_bad_input=True)
        if failure is not None:
            return failure.text
        if self._graph.is_running:
            return None
        return f"roslaunch {self._graph.how_it_ended}{when}, see {self._log_folder}"


def _describe_unresponsive_nodes() -> str:
    """Name unresponsive nodes, for the end of a sentence."""
    silent = unresponsive_nodes()
    return f"; no answer of {', '.join(silent)}" if silent else ""
