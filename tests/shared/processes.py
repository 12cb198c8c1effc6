"""The processes of this machine."""

import contextlib
import os
import uuid
import xmlrpc.client
from pathlib import Path

import psutil
import rosgraph


def marked_environment():
    """Return a unique marker variable, and this environment with it."""
    name, value = "HOME_SERVICE_TEST", str(uuid.uuid4())
    return f"{name}={value}", {**os.environ, "PYTHONUNBUFFERED": "1", name: value}


def processes_of(mark):
    """Return processes with the marker in their environment and their command lines."""
    found = []
    for process in psutil.process_iter():
        with contextlib.suppress(OSError, psutil.Error):
            if mark.encode() in Path(f"/proc/{process.pid}/environ").read_bytes():
                found.append((process, process.cmdline()))
    return found


def processes_with(mark):
    """Return the command lines of the processes with the marker."""
    return [" ".join(words) for _, words in processes_of(mark)]


def node_pid(name):
    """Return the process id of a node; None if it does not answer."""
    try:
        uri = rosgraph.Master("/test").lookupNode(name)
        _code, _text, pid = xmlrpc.client.ServerProxy(uri).getPid("/test")  # type: ignore[misc]
        return pid
    except (OSError, rosgraph.MasterError, xmlrpc.client.Error):
        return None
