"""Run of a project's script under a private ROS master, watched until its work is done."""

import contextlib
import math
import os
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Mapping, Optional, Sequence, Set, Tuple

import psutil
import rospy
from std_msgs.msg import Float64

from evaluation.preload import preload_nodes
from planar_ros.lockstep.transport import HOLD_TOPIC
from rospy_transport.node import end_registration_at_shutdown
from run_project.judging.run_end import GONE_SECONDS, Quiet, is_over
from run_project.ros.observer import Observer
from run_project.ros.processes import (
    BusyProcesses,
    FirstSleeps,
    ListedProcess,
    WallSleeps,
    is_time_due,
    list_processes,
    program_of,
    starting_seconds,
    waits_for_input,
)
from run_project.ros.scripted_user import ScriptedUser
from run_project.script_sleeps import ScriptSleeps
from run_project.stand_ins.sleep import SOCKET_VARIABLE
from run_project.stand_ins.terminal import WindowLogs
from run_project.time_hold import TimeHold
from supervision.display import Display
from supervision.errors import LaunchError
from supervision.processes import adopt_orphans, end_descendants
from supervision.ros.graph import free_port
from supervision.ros.node_api import is_master_online

# Wall time between two looks at the run; before simulated time begins, while a script sleeps until all its
# programs are seen to have come up; and when the end may come at any time.
POLL_SECONDS, STARTING_POLL_SECONDS, ENDING_POLL_SECONDS = 0.2, 0.05, 0.1
MASTER_SECONDS = 30.0
ENTER_SECONDS = 5.0
SIGINT_SECONDS = 4.0
# Wall time in which simulated time must advance.
STALLED_SECONDS = 90.0
# Program in the project's workspace that runs whenever the workspace is sourced: not a node.
SETUP_TOOL = "_setup_util.py"


@dataclass(frozen=True)
class ProjectCommand:
    """The command that runs a project.

    Attributes:
        command: Program and arguments.
        folder: Working folder.
        environment: Environment variables.
        work: Folder of the project's copy; identifies its processes.
        prefix: Command prefix that provides the project's absolute paths.
    """

    command: List[str]
    folder: Path
    environment: Mapping[str, str]
    work: Path
    prefix: Tuple[str, ...] = ()


class ProjectRun:
    """Context of a run: entering starts a ROS master, leaving ends every process of the run.

    Attributes:
        observer: Records what the project does.
        user: Performs the interaction of a course project; None for a script.
        is_over_time: Whether the run was cut short by the time limit.
    """

    def __init__(
        self,
        command: ProjectCommand,
        logs: Path,
        parameters: Mapping[str, object],
        display: Display,
        procedure=None,
    ):
        self._project_command = command
        self._logs = logs
        self._display = display
        self._parameters = parameters
        self.observer = Observer(self._log_event)
        self.user = None if procedure is None else ScriptedUser(procedure, logs.parent, self._log_event)
        self._helpers: List[subprocess.Popen[bytes]] = [preload_nodes(command.prefix)]
        self._recorder: List[psutil.Process] = []
        self._waiting_for_input: Set[int] = set()
        self._windows = WindowLogs(logs)
        self._last_event_wall = self._process_wall = time.monotonic()
        self._node_wall = math.inf
        self.is_over_time = False
        self._busy, self._wall_sleeps, self._first_sleeps = BusyProcesses(), WallSleeps(), FirstSleeps()
        speed = float(str(parameters["/gazebo/speed"]))
        self._hold = TimeHold(speed, lambda: self.observer.simulated_time, lambda at: self._held.publish(at))
        self._resources = contextlib.ExitStack()
        self._sleeps = ScriptSleeps(lambda: self.observer.simulated_time, self._hold)

    def __enter__(self) -> "ProjectRun":
        adopt_orphans()
        port = free_port()
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
        os.environ["ROS_LOG_DIR"] = str(self._logs / "ros")
        try:
            self._start_helper("master", ["rosmaster", "--core", "-p", str(port)])
            self._wait_for_master()
            self._start_helper("rosout", ["rosrun", "rosout", "rosout"])
            for name, value in self._parameters.items():
                rospy.set_param(name, value)
            rospy.init_node("run_project", anonymous=True, disable_signals=True, log_level=rospy.ERROR)
            end_registration_at_shutdown()
            self._held = rospy.Publisher(HOLD_TOPIC, Float64, queue_size=1, latch=True, tcp_nodelay=True)
            if self.user is not None:
                self.user.attach(self.observer.events, self.observer.record.alignment)
            self.observer.start()
            self._resources.enter_context(self._sleeps)
            if self.user is not None:
                self.user.start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if self.user is not None:
            self.user.stop()
        self._resources.close()
        processes = [each.process for each in list_processes(self._helpers)]
        _interrupt(processes)
        rospy.signal_shutdown("the run is over")  # while the others end
        psutil.wait_procs(processes, SIGINT_SECONDS)
        _interrupt(self._recorder)
        psutil.wait_procs(self._recorder, SIGINT_SECONDS)
        end_descendants(2.0)

    def environment(self) -> Dict[str, str]:
        """Environment for programs that join the project's graph."""
        own = {name: os.environ[name] for name in ("ROS_MASTER_URI", "ROS_LOG_DIR")}
        return {**self._project_command.environment, **own, SOCKET_VARIABLE: self._sleeps.address}

    def record(self, bag: Path) -> None:
        """Start recording all topics except images into a bag."""
        command = ["rosbag", "record", "--all", "--exclude", "(.*)camera(.*)", "--output-name", str(bag)]
        self._recorder = [psutil.Process(self._start_helper("record", command).pid)]

    def watch(self, timeout: float) -> Optional[str]:
        """Run the script until its work is done.

        Args:
            timeout: Limit of wall time [s].

        Returns:
            Why the run was cut short, or None.
        """
        deadline = time.monotonic() + timeout
        self._hold.start(time.monotonic())
        script = self._start_script()
        observer, latest_enter = self.observer, time.monotonic()
        moved_wall, moved_time = time.monotonic(), -1.0
        while True:
            now = time.monotonic()
            observer.discover_topics(now)
            windows = self._windows.opened()
            for window in windows:
                self._log_event(f"{observer.simulated_time:7.1f} s  window {window}")
            listed, processes = self._list_processes(now)
            is_starting = self._is_something_starting(listed)
            is_beginning = is_starting or observer.is_graph_new or self._first_sleeps.are_any(listed)
            self._hold.update(now, is_beginning, bool(windows))
            commands, awaited = [each.command for each in listed], str(self._parameters["/gazebo/wait_for"])
            self._sleeps.update(is_starting, is_time_due(commands, awaited, observer.nodes.names))
            self._display.show(observer.status())
            if observer.simulated_time != moved_time:
                moved_wall, moved_time = now, observer.simulated_time
            if now - latest_enter > ENTER_SECONDS:
                latest_enter = now
                _press_enter(script)
            self._busy.lower_priority(processes, now)
            self._report_waiting_programs(processes)
            if self._is_done(script.poll() is not None, now, processes):
                return self._script_failure(script.poll())
            if now > deadline:
                self.is_over_time = True
                return f"not done within {timeout:g} s of wall time"
            if now - moved_wall > STALLED_SECONDS:
                what = (
                    "no simulated time has passed for" if moved_time else "no simulation was started within"
                )
                return f"{what} {STALLED_SECONDS:g} s"
            if not is_master_online():
                return "the ROS master has ended"
            time.sleep(STARTING_POLL_SECONDS if self._hold.is_starting else _pause(observer))

    def _list_processes(self, now: float) -> Tuple[List[ListedProcess], List[psutil.Process]]:
        """All processes of the run but the helpers, and of these the project's own nodes."""
        listed = list_processes(self._helpers)
        nodes = [each.process for each in listed if self._is_of_project(each.command)]
        self._process_wall = now if listed else self._process_wall
        self._node_wall = now if nodes else self._node_wall
        return listed, nodes

    def _is_done(self, script_is_over: bool, now: float, processes: List[psutil.Process]) -> bool:
        if self.user is not None:
            return self.user.is_done
        record, observer = self.observer.record, self.observer
        return is_over(
            record,
            Quiet(now - self._last_event_wall, observer.simulated_time - record.last_event_time),
            script_is_over=script_is_over,
            has_processes=now - self._process_wall <= GONE_SECONDS,
            has_nodes=now - self._node_wall <= GONE_SECONDS,
            has_goal_clients=bool(observer.goal_clients),
            is_one_sleeping=record.all_goals_ended and self._wall_sleeps.are_any(processes, now),
        )

    def _script_failure(self, code: Optional[int]) -> Optional[str]:
        """Why a script failed before it sent a goal or showed a marker: exit code and last line."""
        if not code or self.observer.record.goals or self.observer.record.markers:
            return None
        lines = (self._logs / "script.log").read_text(errors="replace").split("\n")
        last_line = next((line.strip() for line in reversed(lines) if line.strip()), "without output")
        return f"the script ended with exit code {code}: {last_line}"

    def _report_waiting_programs(self, processes: List[psutil.Process]) -> None:
        for process in processes:
            with contextlib.suppress(psutil.Error, OSError):
                if process.pid not in self._waiting_for_input and waits_for_input(process):
                    self._waiting_for_input.add(process.pid)
                    name = Path(program_of(process.cmdline())).stem
                    self._log_event(f"  {name} waits for input: pass --type {name}=TEXT")

    def _log_event(self, event: str) -> None:
        self._last_event_wall = time.monotonic()
        self._display.print(event)

    def _start_helper(self, name: str, command: List[str]) -> "subprocess.Popen[bytes]":
        with (self._logs / f"{name}.log").open("w") as log:
            helper = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        self._helpers.append(helper)
        return helper

    def _start_script(self) -> "subprocess.Popen[bytes]":
        with (self._logs / "script.log").open("w") as log:
            return subprocess.Popen(
                [*self._project_command.prefix, *self._project_command.command],
                cwd=str(self._project_command.folder),
                env=self.environment(),
                stdin=subprocess.PIPE,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    def _wait_for_master(self) -> None:
        deadline = time.monotonic() + MASTER_SECONDS
        while not is_master_online():
            if time.monotonic() > deadline or self._helpers[-1].poll() is not None:
                raise LaunchError(f"no ROS master came up, see {self._logs / 'master.log'}")
            time.sleep(0.05)

    def _is_something_starting(self, listed: Sequence[ListedProcess]) -> bool:
        """Whether a script sleeps by wall time, or a program runs that may become a node of the graph."""
        parents = {each.parent for each in listed}
        return any(
            each.name == "sleep"
            or each.age < starting_seconds(each, each.process.pid in parents, self._is_node(each))
            for each in listed
        )

    def _is_node(self, each: ListedProcess) -> bool:
        """Whether a process is in the graph: by its number, or by its name if it was forked elsewhere."""
        names = {word.partition(":=")[2] for word in each.command if word.startswith("__name:=")}
        return each.process.pid in self.observer.nodes.pids or not names.isdisjoint(self.observer.nodes.names)

    def _is_of_project(self, command: List[str]) -> bool:
        program = program_of(command)
        return str(self._project_command.work) in program and not program.endswith(SETUP_TOOL)


def _pause(observer: Observer) -> float:
    """Wall time until the next look at the run [s]."""
    if observer.simulated_time == 0.0:
        return STARTING_POLL_SECONDS
    return ENDING_POLL_SECONDS if observer.record.all_goals_ended else POLL_SECONDS


def _interrupt(processes: List[psutil.Process]) -> None:
    """Send SIGINT to processes."""
    for process in processes:
        with contextlib.suppress(psutil.NoSuchProcess):
            process.send_signal(signal.SIGINT)


def _press_enter(script: "subprocess.Popen[bytes]") -> None:
    """Send Enter to a script, because some wait for it between two windows."""
    if script.stdin is not None:
        with contextlib.suppress(OSError):
            script.stdin.write(b"\n")
            script.stdin.flush()
