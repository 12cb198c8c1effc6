"""How many files and sockets a process, and those that it starts, may have open."""

import resource

from planar import SettingsError

# What a node of a graph opens at most is about 150, one that records everything.
LEAST, USUAL = 256, 1024


def allow_open_files(wanted: int = USUAL) -> int:
    """Raises the limit of this process to ``wanted``, as far as the system lets it; returns the limit."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft == resource.RLIM_INFINITY:
        return wanted
    if soft < wanted:
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    return soft


def check_open_files() -> None:
    """Sees to it that the nodes of a graph may open what they need. Raises SettingsError."""
    limit = allow_open_files()
    if limit < LEAST:
        raise SettingsError(
            f"no more than {limit} open files are allowed (ulimit -n), and the nodes need {LEAST}"
        )
