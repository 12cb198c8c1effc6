"""One run: a graph brought up, watched, ended, and written down."""

import os
import threading
import time
from argparse import Namespace
from typing import Any, Callable, Dict, List, Optional

import psutil
import rospy
from rosgraph_msgs.msg import Clock

from home_service.judging.verdict import DeliveryRecord, Verdict, judge
from home_service.ros.bags.rosbag_process import RosbagProcess
from home_service.ros.referee import Referee
from home_service.ros.run_recorder import RunRecorder
from planar import FileWriteError, PlanarError
from run_report import RunRecord, summary, write_report
from supervision.display import Display
from supervision.errors import LaunchError
from supervision.interruption import RunInterruptedError, raise_if_interrupted
from supervision.ros.graph import RosGraph
from supervision.ros.node_api import is_master_online
from supervision.run_folder import create_run_folder, write_result
from supervision.versions import versions

POLL_SECONDS = 0.05
BRING_UP_SECONDS = 60.0
REPORT_SECONDS = 60.0


class Run:
    """Context of a run: entering brings the graph up, leaving takes it down, whatever happened."""

    def __init__(self, options: Namespace, launch_file: str, **arguments):
        self._options = options
        self._launch_file = launch_file
        self._speed = getattr(options, "speed", float(options.rviz))
        self._arguments = {
            **({"world_file": options.world.resolve(), "robot": options.robot} if "world" in options else {}),
            "speed": self._speed,
            "seed": options.seed,
            "rviz": str(_wants_rviz(options)).lower(),
            **arguments,
        }
        self._start_wall = psutil.Process().create_time()
        self._deadline = time.monotonic() + options.timeout
        self.folder = create_run_folder(options.output.resolve(), options.command)
        self.display = Display()
        self.referee: Optional[Referee] = None
        self.missing: List[str] = []
        self._recorder: Optional[RunRecorder] = None
        self._bags: Optional[RosbagProcess] = None
        self._graph: Optional[RosGraph] = None
        self._result: Dict[str, Any] = {}

    def __enter__(self) -> "Run":
        self.display.__enter__()
        try:
            self.display.say(f"run folder {self.folder}")
            self._graph = RosGraph("home_service", self._launch_file, self._arguments, self.folder / "log")
            self._wait("the ROS master", is_master_online)
            rospy.init_node("referee", disable_signals=True, anonymous=True, log_level=rospy.ERROR)
            if getattr(self._options, "record", None):
                self._wait("simulated time", lambda: rospy.has_param("/use_sim_time"))
                self._bags = RosbagProcess(self._options.record, self.folder / "bag")
            self.referee = Referee(self._options.places, self.display.say)
            self._recorder = RunRecorder(self._options.places)
            if "world" in self._options:
                self._wait("ground truth from the simulator", lambda: self.referee.truth is not None)
            if self._bags is not None:
                self._wait("the recorder of bags", self._bags.is_ready)
        except BaseException as error:
            self.__exit__(type(error), error, None)
            raise
        return self

    def __exit__(self, _kind, error, _traceback) -> None:
        self.display.show("shutting down")
        if isinstance(error, (PlanarError, RunInterruptedError)):
            self._keep_result(Verdict(False, str(error)))
        if self._bags is not None:
            self.missing += self._bags.close()
        rospy.signal_shutdown("the run is over")
        # The report is made while the nodes end, so that it costs no time.
        reporting = threading.Thread(target=self._report, daemon=True)
        reporting.start()
        if self._graph is not None:
            self._graph.close()
        reporting.join(REPORT_SECONDS)
        if reporting.is_alive():
            self.missing.append(f"the report: not made within {REPORT_SECONDS:g} s")
        for gap in self.missing:
            self.display.say(f"warning: missing: {gap}")
        self.display.say(f"result, report and logs in {self.folder}")
        self.display.__exit__()

    def watch(self, is_over: Callable[[], bool]) -> Optional[str]:
        """Shows progress until ``is_over``; returns why the run cannot go on, or None if it got there."""
        while not is_over():
            raise_if_interrupted()
            failure = self._node_failure()
            if failure:
                return failure
            if not self._graph.is_running:
                return f"roslaunch ended, see {self.folder / 'log'}"
            if time.monotonic() > self._deadline:
                return f"not done within {self._options.timeout:g} s of wall-clock time"
            self.display.show(self._progress())
            time.sleep(POLL_SECONDS)
        return None

    def watch_truth(self) -> Optional[str]:
        """Shows progress until the ground truth of this moment has come; returns as ``watch``."""
        moments: List[float] = []
        clock = rospy.Subscriber("/clock", Clock, lambda message: moments.append(message.clock.to_sec()))
        failure = self.watch(lambda: bool(moments) and self.referee.simulated_time >= moments[0])
        clock.unregister()
        return failure

    def conclude(self, verdict: Verdict, **findings) -> int:
        """Keeps the findings for result.json, prints the verdict, and returns the exit code it deserves."""
        self._keep_result(verdict, **findings)
        word = "SUCCESS" if verdict.success else "FAILURE"
        self.display.say(f"{word}: {verdict.reason}")
        return 0 if verdict.success else 1

    def judge(self, expected) -> Verdict:
        return judge(self.referee.ledger, expected)

    def _progress(self) -> str:
        referee = self.referee
        to_go = "" if referee.distance_to_go is None else f"{referee.distance_to_go:.1f} m to go, "
        return (
            f"{referee.state or 'running'}: {to_go}simulated {referee.simulated_seconds:.1f} s, "
            f"{referee.real_time_factor:.1f} x real time"
        )

    def _wait(self, what: str, is_there: Callable[[], bool]) -> None:
        deadline = time.monotonic() + BRING_UP_SECONDS
        while not is_there():
            raise_if_interrupted()
            failure = self._node_failure()
            if failure is None and not self._graph.is_running:
                failure = f"roslaunch ended before {what} was there, see {self.folder / 'log'}"
            if failure is None and time.monotonic() > deadline:
                failure = f"no {what} within {BRING_UP_SECONDS:g} s, see {self.folder / 'log'}"
            if failure:
                raise LaunchError(failure)
            self.display.show(f"waiting for {what}")
            time.sleep(POLL_SECONDS)

    def _node_failure(self) -> Optional[str]:
        failure = self._graph.failure
        if failure is None:
            return None
        if failure.is_bad_input:
            raise LaunchError(failure.text, is_bad_input=True)
        return failure.text

    def _keep_result(self, verdict: Verdict, **findings) -> None:
        options = self._options
        self._result = {
            "command": options.command,
            "success": verdict.success,
            "reason": verdict.reason,
            "seed": options.seed,
            "speed": self._speed,
            **({"world": str(options.world), "robot": options.robot} if "world" in options else {}),
            **({"map": str(options.map)} if "map" in options else {}),
            **({"mission": str(options.mission)} if getattr(options, "mission", None) else {}),
            "wall_seconds": round(time.time() - self._start_wall, 3),
            **(self._observations() if self.referee else {}),
            **findings,
            "versions": versions(),
        }
        self._write_result()

    def _write_result(self) -> None:
        try:
            write_result(self.folder, {**self._result, "missing": self.missing})
        except FileWriteError as error:
            self.missing.append(f"result.json: {str(error).rpartition(': ')[2]}")

    def _report(self) -> None:
        if self._graph is not None and self._graph.log_gap:
            self.missing.append(self._graph.log_gap)
        record = RunRecord() if self._recorder is None else self._recorder.record()
        self._result.update(summary(record))
        result = {**self._result, "missing": self.missing}
        self.missing = write_report(self.folder, result, record, self._options.gif)
        self._write_result()

    def _observations(self) -> dict:
        referee, ledger = self.referee, self.referee.ledger
        first_motion = referee.first_motion_wall
        return {
            "first_motion_wall_seconds": first_motion and round(first_motion - self._start_wall, 3),
            "simulated_seconds": round(referee.simulated_seconds, 3),
            "real_time_factor": round(referee.real_time_factor, 3),
            "distance_driven": round(referee.distance_driven, 3),
            "position_error": {place: round(error, 4) for place, error in ledger.position_errors.items()},
            "deliveries": [_delivery_of(record) for record in ledger.deliveries],
            "collisions": ledger.collisions,
            "markers": ledger.markers,
            "final_state": ledger.final_state,
        }


def _delivery_of(record: DeliveryRecord) -> dict:
    """A delivery as it stands in result.json; errors in metres."""
    fields = {**vars(record), "from": record.source, "to": record.destination}
    order = ("name", "object", "from", "to", "state", "attempts", "reason", "pickup_error", "dropoff_error")
    return {key: round(fields[key], 4) if isinstance(fields[key], float) else fields[key] for key in order}


def _wants_rviz(options: Namespace) -> bool:
    return options.rviz and bool(os.environ.get("DISPLAY"))
