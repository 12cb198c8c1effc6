"""A launch that a recorder in another process listens to, as rospy joins one graph in its life."""

import contextlib
import multiprocessing
import os
import queue
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Callable, Sequence

from helpers.busy_loops import busy_loops
from supervision.processes import ending_with_parent
from supervision.ros.graph import free_port

MOST_SECONDS, STOP_SECONDS = 690.0, 30.0


def recorded_launch(
    launch: Sequence[str], record: Callable[..., None], arguments: Sequence[Any], busy: int, log: Path
) -> Any:
    """Return what a recorder puts into its queue; exits the program if it puts nothing.

    Args:
        launch: Arguments of roslaunch.
        record: Called in another process with the master's URI, ``arguments`` and the queue.
        arguments: Further arguments of ``record``.
        busy: Number of busy processes beside.
        log: File to which the output is appended.
    """
    with contextlib.ExitStack() as stack:
        environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{free_port()}"}
        environment["ROS_LOG_DIR"] = stack.enter_context(tempfile.TemporaryDirectory())
        stack.enter_context(busy_loops(busy))
        results: Any = multiprocessing.Queue()
        recorder = multiprocessing.Process(
            target=record, args=(environment["ROS_MASTER_URI"], *arguments, results), daemon=True
        )
        recorder.start()
        stack.callback(recorder.terminate)
        command = ["roslaunch", "-p", environment["ROS_MASTER_URI"].rpartition(":")[2], *launch]
        with log.open("ab") as output:
            process = subprocess.Popen(
                command,
                env=environment,
                stdout=output,
                stderr=subprocess.STDOUT,
                preexec_fn=ending_with_parent(),
            )
        stack.callback(_stop, process)
        deadline = time.monotonic() + MOST_SECONDS
        while time.monotonic() < deadline and process.poll() is None:
            with contextlib.suppress(queue.Empty):
                return results.get(timeout=1.0)
        sys.exit(f"no end of the mission ({' '.join(launch)}); see {log}")


def join_graph(master: str) -> None:
    """Make this process a node of the graph at ``master``, once that has started."""
    os.environ["ROS_MASTER_URI"] = master
    import rosgraph
    import rospy

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    while not rosgraph.is_master_online():
        time.sleep(0.1)
    while not rospy.has_param("/use_sim_time"):
        time.sleep(0.02)
    rospy.init_node("recorder", disable_signals=True)


def _stop(process: subprocess.Popen) -> None:
    process.send_signal(signal.SIGINT)
    try:
        process.wait(STOP_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
