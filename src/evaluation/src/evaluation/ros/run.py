"""A run: launch a graph, watch it, end it, and write its results."""

import os
import threading
import time
from contextlib import suppress
from dataclasses import asdict
from typing import Any, Callable, Optional, Sequence

import rospy

from cockpit.process import FREE_PORT, CockpitProcess
from evaluation.consumers.clock_monitor import ClockMonitor
from evaluation.consumers.trace_recorder import TraceRecorder
from evaluation.contracts import Consumer, Judge, Recorder
from evaluation.options import LaunchPlan, RunOptions
from evaluation.result import ResultFile, grouped_by_reason
from evaluation.ros.rosbag_process import RosbagProcess
from evaluation.ros.run_topics import observe
from evaluation.ros.standstill import why_clock_stopped
from evaluation.verdict import Verdict
from planar import PlanarError, SettingsError
from planar_ros.lockstep.client import OBSERVERS_PARAMETER
from planar_ros.node.runner import init_node
from rospy_transport.connections import has_unprocessed
from rospy_transport.replacements import install
from run_report import summary, write_report
from supervision.command_line import words
from supervision.display import Display
from supervision.errors import ResultError
from supervision.interruption import RunInterruptedError, raise_if_interrupted, raise_when_interrupted
from supervision.open_files import check_open_files
from supervision.processes import start_of_this_process
from supervision.ros.node_api import is_master_online
from supervision.ros.supervisor import Supervisor
from supervision.run_folder import create_run_folder
from supervision.streams import ignore_write_errors
from supervision.versions import versions

# Node name of the run's process. The simulator knows it from the start and waits for it.
NODE = "referee"
REPORT_SECONDS = 60.0
# Time in which messages that are in flight at the end of the run are waited for [s].
SETTLE_SECONDS = 1.0
# Time in which those that have arrived are processed, on a very busy machine [s].
PROCESSING_SECONDS = 10.0
# Time that views are left open after the verdict [s].
VIEW_SECONDS = 8.0
NO_DISPLAY = "--rviz: there is no display (DISPLAY is not set); --web shows the run in the browser"


class Run:
    """Context of a run: entering launches the graph, leaving ends it in any case.

    Args:
        options: Options of the command.
        launch: What to launch.
        judge: Observes the run as soon as there is a graph.
        recorder: Observes the run, too.
        display: Terminal output.
        consumers: Further observers.

    Attributes:
        folder: Run folder.
        result: result.json.

    Raises:
        SettingsError: If the run folder cannot be made or a requirement is not met.
    """

    def __init__(
        self,
        options: RunOptions,
        launch: LaunchPlan,
        judge: Judge,
        recorder: Recorder,
        display: Display,
        consumers: Sequence[Consumer] = (),
    ):
        if options.rviz and not os.environ.get("DISPLAY"):
            raise SettingsError(NO_DISPLAY)
        check_open_files()
        self._options, self._launch = options, launch
        self._judge, self._recorder = judge, recorder
        self.display = display
        self.folder = create_run_folder(options.output.resolve(), options.name)
        self.result = ResultFile(self.folder)
        self._supervisor = Supervisor(display, self.folder / "log", options.time_limit)
        self._bags: Optional[RosbagProcess] = None
        self._cockpit: Optional[CockpitProcess] = None
        self._trace = TraceRecorder()
        self._clock_monitor = ClockMonitor(display.print, why_clock_stopped)
        self._consumers = consumers
        self._has_succeeded = False

    def __enter__(self) -> "Run":
        raise_when_interrupted()
        ignore_write_errors()
        self.display.__enter__()
        try:
            self._bring_up()
        except BaseException as error:
            self.__exit__(type(error), error, None)
            raise
        return self

    def __exit__(self, _kind, error, _traceback) -> None:
        """End the graph and write the report.

        Raises:
            ResultError: If a successful run could not write its result.
        """
        # The report is written while the nodes end, so that it costs no time.
        reporting = threading.Thread(target=self._write_report, daemon=True)
        try:
            self._finish(error)
            reporting.start()
        finally:
            self._supervisor.end()
        reporting.join(REPORT_SECONDS)
        if reporting.is_alive():
            self.result.missing.append(f"report: not written within {REPORT_SECONDS:g} s")
        lacks_result = error is None and self._has_succeeded and self.result.gap is not None
        gaps = self.result.missing if lacks_result else self.result.all_missing
        for gap in grouped_by_reason(gaps):
            self.display.print(f"warning: missing: {gap}")
        self.display.print(f"result, report and logs in {self.folder}")
        self.display.__exit__()
        if lacks_result:
            raise ResultError(f"{self.folder}/{self.result.gap}: without it the run is no success")

    def watch(self, is_over: Callable[[], bool]) -> Optional[str]:
        """Show progress until ``is_over``.

        Returns:
            Why the run cannot continue, or None once it is over.

        Raises:
            LaunchError: If a node rejected its input.
            RunInterruptedError: At Ctrl-C.
        """
        failure = self._supervisor.watch(is_over, self._status)
        standstill = self._clock_monitor.reason
        return f"{failure}; {standstill}" if failure and standstill else failure

    @property
    def end_of_graph(self) -> Optional[str]:
        """Why the graph has ended, or None; also after Ctrl-C. Raises LaunchError as ``watch`` does."""
        return self._supervisor.end_of_graph

    def _status(self) -> str:
        self._clock_monitor.check()
        return self._judge.status()

    def conclude(self, verdict: Verdict, **findings: Any) -> int:
        """Write result.json, print the verdict, and return the exit code."""
        figures = {**self._judge.result_fields(), **findings}
        self._await_messages_in_flight()
        self._record_result(verdict, **figures)
        if self.result.gap is not None:
            verdict = Verdict(False, f"{self.result.gap}; what the run came to: {verdict.reason}")
            self.result.add(success=False, reason=verdict.reason)
        self._has_succeeded = verdict.success
        self.display.print(f"{'SUCCESS' if verdict.success else 'FAILURE'}: {verdict.reason}")
        return 0 if verdict.success else 1

    def _await_messages_in_flight(self) -> None:
        """Wait until what was published before the end is processed, such as the outcome of the last goal.

        Each topic has a thread, and any of them may be behind that of the ground truth.
        """
        _wait_until(self._trace.is_settled, SETTLE_SECONDS)
        if not _wait_until(lambda: not has_unprocessed(), PROCESSING_SECONDS):
            self.result.missing.append(f"end of the trace: not processed within {PROCESSING_SECONDS:g} s")

    def _bring_up(self) -> None:
        self.display.print(f"run folder {self.folder}")
        speed = {"speed": self._options.effective_speed, "rviz": str(self._options.rviz).lower()}
        launch = self._launch
        observers = {"observers": NODE} if launch.is_simulated else {}
        arguments = {**launch.arguments, **speed, **observers}
        self._supervisor.start(launch.package, launch.file, arguments, launch.respawned)
        if self._options.shows_cockpit:
            where = self._options.web_port or FREE_PORT
            self._cockpit = CockpitProcess(where, self.folder / "log" / "cockpit.log", tool=launch.tool)
            self.display.print(f"cockpit: {self._cockpit.url}")
        wait_for = self._supervisor.wait_for
        wait_for("the ROS master", is_master_online)
        if launch.bags is not None:
            wait_for("simulated time", _is_time_simulated)
            self._bags = RosbagProcess(launch.bags, self.folder / "bag")
        self._supervisor.run_in_thread("the run's own node", self._subscribe)
        if self._launch.is_simulated:
            wait_for("ground truth from the simulator", self._judge.has_truth)
        if self._bags is not None:
            wait_for("the recorder of bags", self._bags.is_ready)

    def _subscribe(self) -> None:
        """Make this process a node and observe the run."""
        install(notes_receipt=True)
        init_node(NODE, log_level=rospy.ERROR)
        clock = (self._clock_monitor,) if self._launch.is_simulated else ()
        observe(self._trace, *clock, self._judge, self._recorder, *self._consumers)
        rospy.set_param(OBSERVERS_PARAMETER, [rospy.get_name()])

    def _finish(self, error: Optional[BaseException]) -> None:
        """Do what must be done before the nodes end."""
        if error is None and self._options.has_view:
            self._keep_view_open()
        self.display.show("shutting down")
        if self._cockpit is not None:
            self._cockpit.close()
        if isinstance(error, (PlanarError, RunInterruptedError)):
            self._record_result(Verdict(False, str(error)))
        if self._bags is not None:
            self.result.missing += self._bags.close()
        if not self._supervisor.has_pending_work:  # otherwise rospy would wait for its locks
            rospy.signal_shutdown("the run is over")

    def _keep_view_open(self) -> None:
        """Leave the views open for a while; Ctrl-C closes them."""
        ending = time.monotonic() + VIEW_SECONDS
        with suppress(RunInterruptedError):
            self.display.print(f"the view stays open for {VIEW_SECONDS:g} s; Ctrl-C closes it")
            while time.monotonic() < ending:
                raise_if_interrupted()
                time.sleep(0.05)

    def _record_result(self, verdict: Verdict, **findings: Any) -> None:
        about = {"command": self._options.name, "success": verdict.success, "reason": verdict.reason}
        self.result.add(**about, **self._options.result_fields(), arguments=words(self._options))
        self.result.add(wall_seconds=round(time.time() - start_of_this_process(), 3))
        self.result.add(restarts=[asdict(restart) for restart in self._supervisor.restarts])
        if self._launch.is_simulated:
            self._trace.save(self.result)
        self.result.add(**{**self._judge.result_fields(), **findings, "versions": versions()})
        self.result.write()

    def _write_report(self) -> None:
        if self._supervisor.log_gap:
            self.result.missing.append(self._supervisor.log_gap)
        record = self._recorder.record()
        self.result.add(**summary(record))
        self.result.missing = write_report(self.folder, self.result.content, record, self._options.gif)
        self.result.write()


def _wait_until(holds: Callable[[], bool], seconds: float) -> bool:
    """Wait, and return whether it holds."""
    deadline = time.monotonic() + seconds
    while not (does_hold := holds()) and time.monotonic() < deadline:
        time.sleep(0.005)
    return does_hold


def _is_time_simulated() -> bool:
    with suppress(OSError):
        return rospy.has_param("/use_sim_time")
    return False
