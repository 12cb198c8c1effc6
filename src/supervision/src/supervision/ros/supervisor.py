"""A graph under supervision: brought up, watched until its work is done, ended."""

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
    """Starts a graph, waits for its parts, and notices when it cannot go on; Ctrl-C is heard meanwhile."""

    def __init__(self, display: Display, log_folder: Path, time_limit: float):
        """``time_limit``: wall-clock seconds from now after which a watch gives up."""
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
        """Launches the graph; nodes in ``comes_back`` may die, and are started again. Raises LaunchError."""
        self._graph = RosGraph(package, launch_file, arguments, self._log_folder, respawned)

    def wait_for(self, what: str, is_there: Callable[[], bool]) -> None:
        """Waits for a part of the graph. Raises LaunchError if it does not come."""
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
        """Does ``work`` in a thread, for which what asks the master may wait for ever once that is gone.

        An OSError of it is the master's end. Raises LaunchError then.
        """
        working = self._work = Future()

        def do():
            try:
                working.set_result(work())
            except OSError:
                pass  # what became of the graph says why
            except Exception as error:
                working.set_exception(error)

        threading.Thread(target=do, daemon=True).start()
        self.wait_for(what, working.done)
        working.result()

    @property
    def has_pending_work(self) -> bool:
        """Whether something that was to be carried out is not, and will not be."""
        return self._work is not None and not self._work.done()

    def watch(self, is_over: Callable[[], bool], status: Callable[[], str]) -> Optional[str]:
        """Shows how things stand until ``is_over``; returns why it cannot come to that, or None."""
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
        """Ends every process of the graph, also of one whose start was interrupted."""
        if self._graph is not None:
            self._graph.close()
        else:
            end_descendants()

    @property
    def end_of_graph(self) -> Optional[str]:
        """Why nothing runs any more, or None; also after Ctrl-C. Raises LaunchError as ``watch`` does."""
        is_running = self._graph is not None and self._graph.is_running
        return None if is_running else self._failure_of_graph()

    @property
    def log_gap(self) -> Optional[str]:
        """What is missing of the graph's log, and why."""
        return None if self._graph is None else self._graph.log_gap

    @property
    def restarts(self) -> List[Restart]:
        """The nodes that died and came back."""
        return [] if self._graph is None else self._graph.exits.restarts

    def _show_restarts(self) -> None:
        for restart in self.restarts[self._restarts_shown :]:
            self._display.print(f"{restart.node}: {restart.reason}: started again")
            self._restarts_shown += 1

    def _failure(self, when: str = "") -> Optional[str]:
        """Why the graph cannot go on. Raises LaunchError if a node refused its input."""
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
    """Of nodes that are there and do not answer, for the end of a sentence."""
    silent = unresponsive_nodes()
    return f"; no answer of {', '.join(silent)}" if silent else ""
