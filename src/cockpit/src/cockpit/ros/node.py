"""The process of the cockpit: serves the page, then waits for the ROS master.

cockpit [--web-port [ADDRESS:]PORT] [--tool NAME]
"""

import faulthandler
import os
import sys
import threading
import time
from dataclasses import dataclass
from typing import Any, Callable, Optional, Tuple

import rospy
from rosgraph import get_master_uri

from cockpit.errors import CockpitError, PortError
from cockpit.layers import all_layers
from cockpit.page.server import Page
from cockpit.ros.cockpit import CockpitController
from cockpit.ros.tools import all_tools, names
from cockpit.ros.world.scene_reader import SceneReader
from planar import PlanarError
from planar_ros.node.runner import init_node
from supervision.command_line import option, parse
from supervision.interruption import leave, on_signals
from supervision.ros.node_api import is_master_online, node_names

FREE_PORT = "127.0.0.1:0"
MASTER_SECONDS, NODES_SECONDS = 0.2, 3.0
CLOSE_SECONDS = 15.0
# The graph has priority on a busy machine.
NICENESS = 5


@dataclass(frozen=True)
class CockpitOptions:
    """Shows and drives a running ROS graph in the browser."""

    web_port: str = option(
        FREE_PORT, "address of the page; port 0 selects a free one", metavar="[ADDRESS:]PORT"
    )
    tool: Optional[str] = option(None, "a tool that is opened first", metavar="NAME")


def main() -> None:
    options = parse(CockpitOptions, rospy.myargv()[1:], "cockpit")
    try:
        leave(serve(options.web_port, options.tool))
    except PlanarError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)


def serve(where: str, tool: Optional[str], words: Tuple[str, ...] = ()) -> int:
    """Serve the page until the process is interrupted.

    The page ends with the process: viser would wait for browsers that have disconnected.

    Args:
        where: [ADDRESS:]PORT of the page.
        tool: Name of a tool that is opened first.
        words: Arguments of the tool.

    Returns:
        Exit code.

    Raises:
        CockpitError: If an option is invalid.
    """
    check_tool(tool)
    page = Page(*address_of(where))
    print(f"cockpit: {page.url}", flush=True)
    os.nice(NICENESS)
    reader = _preload()
    if not is_master_online():
        print(f"cockpit: waiting for a ROS master at {get_master_uri()}", flush=True)
    while not is_master_online():
        time.sleep(MASTER_SECONDS)
    _wait_for_nodes()
    is_interrupted = _install_signal_handlers()
    init_node("cockpit", anonymous=True, log_level=rospy.WARN)
    cockpit = CockpitController(page, reader)
    if tool is not None:
        cockpit.toolbox.open(tool, words)
    cockpit.run(lambda: is_interrupted() or rospy.is_shutdown())
    rospy.signal_shutdown("the cockpit ends")
    return 0


def _preload() -> SceneReader:
    """Load layers, tools and the scene reader while there is no graph yet."""
    reader = SceneReader()
    reader.prepare()
    all_layers()
    all_tools()
    return reader


def _install_signal_handlers() -> Callable[[], bool]:
    """Return a function that reports whether a signal has arrived.

    If the process does not end in time after a signal, it prints where it waits and exits. rospy's handler is
    not used: it calls the master inside the interrupted thread, which may be calling it as well.
    """
    ending = threading.Event()

    def end(_number: int, _frame: Any) -> None:
        faulthandler.dump_traceback_later(CLOSE_SECONDS, exit=True)
        ending.set()

    on_signals(end)
    return ending.is_set


def _wait_for_nodes() -> None:
    """Wait for the first nodes: use_sim_time is set before they start, and rospy reads it once."""
    deadline = time.monotonic() + NODES_SECONDS
    while time.monotonic() < deadline and not set(node_names()) - {"/rosout"}:
        time.sleep(MASTER_SECONDS)


def check_tool(name: Optional[str]) -> None:
    """Check the name of a tool; None is valid.

    Raises:
        CockpitError: There is no such tool.
    """
    if name is not None and name not in names():
        raise CockpitError(f"--tool: unknown tool '{name}'; expected one of {', '.join(names())}")


def address_of(text: str) -> Tuple[str, int]:
    """Parse ``[ADDRESS:]PORT``.

    Raises:
        PortError: The text has another form.
    """
    address, _, port = text.rpartition(":")
    if not port.isascii() or not port.isdigit() or int(port) > 65535:
        raise PortError(
            f"--web-port: '{text}' is not valid; expected [ADDRESS:]PORT with a port from 0 to 65535"
        )
    return address.strip("[]") or "127.0.0.1", int(port)


if __name__ == "__main__":
    main()
