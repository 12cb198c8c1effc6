"""The process of the cockpit: the page first, then the graph, whenever its master comes.

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
from cockpit.ros.cockpit import Cockpit
from cockpit.ros.tools import all_tools, names
from cockpit.ros.world.scene_reader import SceneReader
from planar import PlanarError
from planar_ros.node.shell import init_node
from supervision.command_line import option, parse
from supervision.interruption import leave, on_signals
from supervision.ros.node_api import is_master_online, node_names

FREE_PORT = "127.0.0.1:0"
MASTER_SECONDS, NODES_SECONDS = 0.2, 3.0
CLOSE_SECONDS = 15.0
# Where processors are short, the graph goes first.
NICENESS = 5


@dataclass(frozen=True)
class CockpitOptions:
    """Shows and drives a running ROS graph in the browser."""

    web_port: str = option(FREE_PORT, "where the page is served; 0: a free port", metavar="[ADDRESS:]PORT")
    tool: Optional[str] = option(None, "a tool that is open at first", metavar="NAME")


def main() -> None:
    options = parse(CockpitOptions, rospy.myargv()[1:], "cockpit")
    try:
        leave(serve(options.web_port, options.tool))
    except PlanarError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)


def serve(where: str, tool: Optional[str], words: Tuple[str, ...] = ()) -> int:
    """Until the process is interrupted; ``words``: what the tool is to show at first.

    The end of the process is the end of the page: viser would wait for browsers that are gone.
    Raises CockpitError if the options make no sense.
    """
    check_tool(tool)
    page = Page(*address_of(where))
    print(f"cockpit: {page.url}", flush=True)
    os.nice(NICENESS)
    reader = _get_ready()
    if not is_master_online():
        print(f"cockpit: waiting for a ROS master at {get_master_uri()}", flush=True)
    while not is_master_online():
        time.sleep(MASTER_SECONDS)
    _wait_for_nodes()
    is_asked_to_end = _hear_signals()
    init_node("cockpit", anonymous=True, log_level=rospy.WARN)
    cockpit = Cockpit(page, reader)
    if tool is not None:
        cockpit.toolbox.open(tool, words)
    cockpit.run(lambda: is_asked_to_end() or rospy.is_shutdown())
    rospy.signal_shutdown("the cockpit ends")
    return 0


def _get_ready() -> SceneReader:
    """What can be done before there is a graph, which would have to wait for it later."""
    reader = SceneReader()
    reader.prepare()
    all_layers()
    all_tools()
    return reader


def _hear_signals() -> Callable[[], bool]:
    """Tells whether one has come; the process ends in time whatever is waited for, and says what that was.

    rospy's own handler asks the master, in the middle of what the thread it interrupts may just ask it.
    """
    ending = threading.Event()

    def end(_number: int, _frame: Any) -> None:
        faulthandler.dump_traceback_later(CLOSE_SECONDS, exit=True)
        ending.set()

    on_signals(end)
    return ending.is_set


def _wait_for_nodes() -> None:
    """A graph that just begins says whose time it has before its first nodes come; a node asks once."""
    deadline = time.monotonic() + NODES_SECONDS
    while time.monotonic() < deadline and not set(node_names()) - {"/rosout"}:
        time.sleep(MASTER_SECONDS)


def check_tool(name: Optional[str]) -> None:
    """Raises CockpitError if it is neither None nor the name of a tool."""
    if name is not None and name not in names():
        raise CockpitError(f"--tool: there is no '{name}', only {', '.join(names())}")


def address_of(text: str) -> Tuple[str, int]:
    """Address and port of ``[ADDRESS:]PORT``. Raises PortError."""
    address, _, port = text.rpartition(":")
    if not port.isascii() or not port.isdigit() or int(port) > 65535:
        raise PortError(f"--web-port: '{text}' is no port, nor an address and a port")
    return address.strip("[]") or "127.0.0.1", int(port)


if __name__ == "__main__":
    main()
