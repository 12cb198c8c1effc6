"""The HTTP server, in a separate thread."""

import json
import os
import socket
import threading
from pathlib import Path
from typing import Optional

import uvicorn

from planar import SettingsError
from service.host import ServiceHost
from service.http.access import LOOPBACK, AccessGuard, new_token
from service.http.app import make_app
from service.http.client import ADDRESS_FILE

MAX_CONNECTIONS, START_SECONDS, END_SECONDS = 500, 10.0, 3.0
VERSION = "1.0.0"


class HttpServer:
    """Serves a service, and writes its address and token to ``service.json``, which only the user may read.

    Args:
        host: The service.
        folder: Folder for the file.
        address: Address to listen on.
        port: Port; 0 for a free one.

    Attributes:
        url: Address of the server.
        token: Its token.

    Raises:
        SettingsError: If the address cannot be used.
    """

    def __init__(self, host: ServiceHost, folder: Path, address: str = "127.0.0.1", port: int = 0):
        self.token, self._file = new_token(), folder / ADDRESS_FILE
        self._socket = _listening(address, port)
        number = self._socket.getsockname()[1]
        self.url = f"http://{'[' + address + ']' if ':' in address else address}:{number}"
        hosts = () if address in LOOPBACK else (address, socket.gethostname())
        config = uvicorn.Config(
            AccessGuard(make_app(host, VERSION), self.token, hosts),
            log_level="error",
            access_log=False,
            lifespan="off",
            loop="asyncio",
            http="h11",
            ws="none",
            limit_concurrency=MAX_CONNECTIONS,
            timeout_graceful_shutdown=1,
        )
        self._server = uvicorn.Server(config)
        self._thread = threading.Thread(target=self._run, name="http", daemon=True)

    def start(self) -> None:
        """Start the thread, and write the file."""
        self._thread.start()
        self._file.parent.mkdir(parents=True, exist_ok=True)
        beside = self._file.with_suffix(".new")
        beside.unlink(missing_ok=True)
        descriptor = os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(descriptor, "w") as file:
            json.dump({"url": self.url, "token": self.token, "pid": os.getpid()}, file)
        beside.replace(self._file)

    def stop(self) -> None:
        """End the server, and remove the file."""
        self._server.should_exit = True
        self._thread.join(END_SECONDS)
        self._file.unlink(missing_ok=True)

    def _run(self) -> None:
        self._server.run([self._socket])


def _listening(address: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in address else socket.AF_INET
    listening: Optional[socket.socket] = None
    try:
        listening = socket.socket(family, socket.SOCK_STREAM)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((address, port))
        listening.listen(512)
    except OSError as error:
        if listening is not None:
            listening.close()
        raise SettingsError(
            f"port {port} of {address} cannot be used ({error.strerror}); name another"
        ) from None
    return listening
