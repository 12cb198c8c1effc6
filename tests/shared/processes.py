"""What is running on this machine."""

from pathlib import Path

import psutil


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
