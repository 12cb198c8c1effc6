"""Run a program in a child of the preloaded process, which has already imported what it needs.

The launching process starts the server (``supervision.fork_server``) and passes its address in the
environment.
"""

import array
import json
import os
import signal
import socket
import struct
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any, NoReturn

from supervision.interruption import SIGNALS, exiting_on_signals

FORK_SERVER = "HOME_SERVICE_FORK_SERVER"
STREAMS = (0, 1, 2)
LARGEST_MESSAGE = 2**17
ANSWER_SECONDS = 20.0
# Sent to the child, which waits for it, when signals are forwarded.
BEGIN = b"begin"
CREDENTIALS = struct.Struct("3i")


def run_in_fork_server(function: str, *arguments: str) -> None:
    """Call a function in a child of the server and exit like that child.

    Command line, environment, folder and streams of the child are those of this process, termination
    signals are forwarded to it, and it is killed if this process is. Returns if there is no server that
    responds.

    Args:
        function: Function as ``package.module:name``.
        *arguments: Its arguments.
    """
    address = os.environ.get(FORK_SERVER)
    if not address:
        return
    request = {
        "call": [function, *arguments],
        "argv": sys.argv,
        "path": sys.path,
        "environment": dict(os.environ),
        "folder": str(Path.cwd()),
    }
    with exiting_on_signals(), socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as connection:
        connection.settimeout(ANSWER_SECONDS)
        try:
            connection.connect(f"\0{address}")
            if user_of_peer(connection) != os.getuid():
                return
            streams = array.array("i", STREAMS)
            rights = [(socket.SOL_SOCKET, socket.SCM_RIGHTS, streams)]
            connection.sendmsg([json.dumps(request).encode()], rights)
            child = connection.recv(LARGEST_MESSAGE)
        except OSError:
            return
        if child:
            _follow_child(int(child), connection)


def user_of_peer(connection: socket.socket) -> int:
    """Return the user id of the process at the other end of a Unix socket."""
    credentials = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, CREDENTIALS.size)
    return CREDENTIALS.unpack(credentials)[1]


def exit_like(code: int) -> NoReturn:
    """Exit like another process; a negative ``code`` is the number of the signal that ended it."""
    if code < 0:
        with suppress(OSError):  # SIGKILL has no handler
            signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    sys.exit(code)


def _follow_child(child: int, connection: socket.socket) -> NoReturn:
    def forward_signal(number: int, _frame: Any) -> None:
        with suppress(ProcessLookupError):
            os.kill(child, number)

    for number in SIGNALS:
        signal.signal(number, forward_signal)
    connection.settimeout(None)
    with suppress(OSError):
        connection.send(BEGIN)
    code = connection.recv(LARGEST_MESSAGE)
    exit_like(int(code) if code else -signal.SIGKILL)
