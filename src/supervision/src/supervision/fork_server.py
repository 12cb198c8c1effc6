"""Preloaded process (forkserver): imports modules once and forks a child for each client.

python3 -m supervision.fork_server NAME (MODULE | MODULE:FUNCTION)...

Imports take most of a node's start-up time: here they are made once, while roslaunch still reads the launch
files. The server listens at the abstract Unix socket NAME, for processes of the same user only. A client that
connects during the imports waits for all of them if it calls a function of one of the modules, and for its
own module only if it is another program. The server ends with the process that has started it.
"""

import array
import ctypes
import fcntl
import gc
import importlib
import json
import os
import random
import secrets
import select
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from supervision.fork_client import ANSWER_SECONDS, FORK_SERVER, LARGEST_MESSAGE, STREAMS, user_of_peer
from supervision.interruption import before_exit
from supervision.processes import end_descendants, ending_with_parent

WAITING_CLIENTS = 64
REQUEST_SECONDS = 1.0
# Defined by Linux, not by the module fcntl.
F_SETSIG = 10
# Request of a client, and the connection to it.
_Client = Tuple[Dict[str, Any], socket.socket]


def start_fork_server(preparations: Sequence[str], prefix: Sequence[str] = ()) -> "subprocess.Popen[bytes]":
    """Start a preloaded process and put its address into the environment.

    Must be called by the main thread, with which it ends; it has ended when this process exits
    (``supervision.interruption``).

    Args:
        preparations: Modules to import and functions to call, as ``package.module:name``.
        prefix: Words that precede the command; the program they run has to execute it in its own process.
    """
    name = f"home_service_{os.getpid()}_{secrets.token_hex(8)}"
    command = [*prefix, sys.executable, "-m", "supervision.fork_server", name, *preparations]
    # Threads of BLAS are not forked, so children cannot use them.
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    os.environ[FORK_SERVER] = name
    before_exit(end_descendants)
    return subprocess.Popen(
        command,
        env=environment,
        stdin=subprocess.DEVNULL,
        start_new_session=True,
        preexec_fn=ending_with_parent(signal.SIGTERM),
    )


def main() -> None:
    name, *preparations = sys.argv[1:]
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        listener.bind(f"\0{name}")
        listener.listen(WAITING_CLIENTS)
        gc.disable()  # nearly all objects stay alive
        request, connection = _ForkServer(listener).serve(preparations)
    gc.freeze()  # so that this child shares the server's memory
    gc.enable()
    _take_over_client(request, connection)
    _call(*request["call"])


def _call(what: str, *arguments: str) -> None:
    """Import a module; call its function if ``what`` is ``package.module:function``."""
    name, _, function = what.partition(":")
    module = importlib.import_module(name)
    if function:
        getattr(module, function)(*arguments)


class _ForkServer:
    """Forks a child for each client and sends the client its process id and then its exit code."""

    def __init__(self, listener: socket.socket):
        self._listener = listener
        self._clients: Dict[int, socket.socket] = {}
        self._waiting: List[_Client] = []
        # Also while modules are imported, so that no client waits for them at its end.
        signal.signal(signal.SIGCHLD, lambda _number, _frame: self._report_exits())

    def serve(self, preparations: Sequence[str]) -> _Client:
        """Prepare, and serve for ever; returns in each child the request and the connection to its client."""
        prepared = {preparation.partition(":")[0] for preparation in preparations}
        for preparation in preparations:
            with suppress(Exception):  # the node that needs it fails and reports the error
                _call(preparation)
            while select.select([self._listener], [], [], 0.0)[0]:
                self._receive()
            child = self._start_clients(lambda module: module in sys.modules and module not in prepared)
            if child is not None:
                return child
        gc.freeze()  # so that children share unchanged memory
        while True:
            child = self._start_clients(lambda _module: True)
            if child is not None:
                return child
            self._receive()

    def _receive(self) -> None:
        """Receive the request of the next client."""
        connection, _ = self._listener.accept()
        request = _received(connection)
        if request is None:
            connection.close()
        else:
            self._waiting.append((request, connection))

    def _start_clients(self, may_start: Callable[[str], bool]) -> Optional[_Client]:
        """Fork for the waiting clients whose modules may start; return the client in its child."""
        waiting, self._waiting = self._waiting, []
        for number, (request, connection) in enumerate(waiting):
            if not may_start(_module_of(request)):
                self._waiting.append((request, connection))
            elif self._is_child(connection, request["streams"]):
                for other in (*self._waiting, *waiting[number + 1 :]):
                    _close(*other)
                return request, connection
        return None

    def _is_child(self, connection: socket.socket, streams: List[int]) -> bool:
        child = os.fork()
        if child:
            _close_all(streams)
            with suppress(OSError):
                connection.send(str(child).encode())
            self._clients[child] = connection
            self._report_exits()  # it may have ended before it was among the clients
            return False
        for ours, theirs in zip(STREAMS, streams):
            os.dup2(theirs, ours)
            os.close(theirs)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        for client in self._clients.values():
            client.close()
        return True

    def _report_exits(self) -> None:
        """Report the exit codes of children that have ended; a signal may call it while it runs."""
        for child in list(self._clients):
            with suppress(ChildProcessError):  # reported meanwhile
                ended, status = os.waitpid(child, os.WNOHANG)
                if ended:
                    code = -os.WTERMSIG(status) if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)
                    with self._clients.pop(child) as client, suppress(OSError):
                        client.send(str(code).encode())


def _received(connection: socket.socket) -> Optional[Dict[str, Any]]:
    """Return the request of a client of the same user, with its ``streams``; None if it is not valid."""
    if user_of_peer(connection) != os.getuid():
        return None
    connection.settimeout(REQUEST_SECONDS)
    streams = array.array("i")
    with suppress(OSError, ValueError, TypeError, LookupError):
        size = socket.CMSG_LEN(len(STREAMS) * streams.itemsize)
        text, rights, _, _ = connection.recvmsg(LARGEST_MESSAGE, size)
        for _level, _kind, data in rights:
            streams.frombytes(data)
        request = {**json.loads(text), "streams": list(streams)}
        if ":" in request["call"][0]:
            return request
    _close_all(streams)
    return None


def _module_of(request: Dict[str, Any]) -> str:
    """Return the module of the last function in a call, which those before only prepare for."""
    functions = [word for word in request["call"] if ":" in word]
    return str(functions[-1]).partition(":")[0]


def _close(request: Dict[str, Any], connection: socket.socket) -> None:
    """Close what belongs to another client, in a child."""
    _close_all(request["streams"])
    connection.close()


def _close_all(streams: Sequence[int]) -> None:
    for stream in streams:
        os.close(stream)


def _take_over_client(request: Dict[str, Any], connection: socket.socket) -> None:
    """Give this child the identity of its client: session, streams, environment, command line."""
    _wait_for_client(connection)
    _end_with_client(connection)
    os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    sys.stdout.reconfigure(line_buffering=os.isatty(1))  # type: ignore[union-attr]
    os.environ.clear()
    os.environ.update(request["environment"])
    os.chdir(request["folder"])
    sys.argv, sys.path[:] = request["argv"], request["path"]
    random.seed()
    _name_process([sys.executable, *sys.argv])


def _wait_for_client(connection: socket.socket) -> None:
    """Until it hands signals on; ends with it."""
    connection.settimeout(ANSWER_SECONDS)
    with suppress(OSError):
        if connection.recv(LARGEST_MESSAGE):
            return
    os._exit(1)


def _end_with_client(connection: socket.socket) -> None:
    """The kernel kills this process when the other end of the connection, which sends no more, is closed."""
    connection.setblocking(False)
    fcntl.fcntl(connection, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(connection, F_SETSIG, signal.SIGKILL)
    fcntl.fcntl(connection, fcntl.F_SETFL, fcntl.fcntl(connection, fcntl.F_GETFL) | os.O_ASYNC)
    with suppress(BlockingIOError):
        if not connection.recv(1, socket.MSG_PEEK):
            os.kill(os.getpid(), signal.SIGKILL)


def _name_process(words: List[str]) -> None:
    """Set the command line shown by ps, as far as that of this process has room."""
    fields = Path("/proc/self/stat").read_text().rpartition(")")[2].split()
    start, end = int(fields[45]), int(fields[46])
    room = end - start
    text = "\0".join(words).encode()[: room - 1].ljust(room, b"\0")
    ctypes.memmove(start, text, room)


if __name__ == "__main__":
    main()
