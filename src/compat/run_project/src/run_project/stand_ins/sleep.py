"""Stand-in for ``sleep``: asks the run to wait, by simulated time."""

import math
import os
import socket
from typing import List, Optional

from run_project.stand_ins import without_stand_ins

# Name of the run's socket, in Linux's abstract namespace.
SOCKET_VARIABLE = "RUN_PROJECT_SLEEPS"
UNITS = {"s": 1.0, "m": 60.0, "h": 3600.0, "d": 86400.0}
CONNECT_SECONDS = 5.0


def main(arguments: List[str]) -> None:
    """Sleep for the durations in the arguments; outside a run, or for others, the real program does it."""
    seconds = seconds_of(arguments)
    if seconds is None or not sleep_within_run(seconds, os.environ.get(SOCKET_VARIABLE, "")):
        os.execvpe("sleep", ["sleep", *arguments], without_stand_ins(os.environ))


def seconds_of(arguments: List[str]) -> Optional[float]:
    """Return the sum of durations such as ``1.5`` or ``2m`` [s]; None if one is anything else."""
    total = 0.0
    for word in arguments:
        number, unit = (word[:-1], word[-1]) if word[-1:] in UNITS else (word, "s")
        try:
            duration = float(number) * UNITS[unit]
        except ValueError:
            return None
        if not (math.isfinite(duration) and duration >= 0.0):
            return None
        total += duration
    return total if arguments else None


def sleep_within_run(seconds: float, address: str) -> bool:
    """Wait until the run closes the connection; return False if there is no run to ask."""
    if not address:
        return False
    with socket.socket(socket.AF_UNIX) as connection:
        try:
            connection.settimeout(CONNECT_SECONDS)
            connection.connect(f"\0{address}")
            connection.sendall(f"{seconds!r}\n".encode())
            connection.settimeout(None)
            connection.recv(1)
        except OSError:
            return False
    return True
