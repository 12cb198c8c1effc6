"""A program that lives on in a child of a fork server, which has imported already what it needs.

Who starts many programs runs such a server (``supervision.fork_server``) and names it in their environment.
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
# What the child waits for before it begins: from now on signals are handed on.
BEGIN = b"begin"
CREDENTIALS = struct.Struct("3i")


def run_in_fork_server(function: str, *arguments: str) -> None:
    """Ends as the child does in which the server calls the function (``package.module:name``).

    Command line, environment, folder and streams are this process' own there, signals that ask for an end are
    handed on, and the child is killed where this process is. Returns if there is no server that answers.
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
    """The number of the user whose process is at the other end of a Unix socket."""
    credentials = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, CREDENTIALS.size)
    return CREDENTIALS.unpack(credentials)[1]


def exit_like(code: int) -> NoReturn:
    """Ends this process as another has ended: a negative ``code`` is the number of the signal that did it."""
    if code < 0:
        with suppress(OSError):  # nobody may tell what SIGKILL is to do
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
