"""What is running on this machine."""

import os
import uuid
from pathlib import Path

import psutil


def marked_environment():
    """A mark that no process has yet, and this environment with it."""
    name, value = "HOME_SERVICE_TEST", str(uuid.uuid4())
    return f"{name}={value}", {**os.environ, "PYTHONUNBUFFERED": "1", name: value}


def processes_of(mark):
    """Living processes whose environment holds ``mark``."""
    found = []
    for process in psutil.process_iter():
        try:
            if mark.encode() in Path(f"/proc/{process.pid}/environ").read_bytes():
                found.append(process)
        except (OSError, psutil.Error):
            continue
    return found


def processes_with(mark):
    """Their command lines."""
    found = []
    for process in processes_of(mark):
        try:
            found.append(" ".join(process.cmdline()))
        except psutil.Error:
            continue
    return found
