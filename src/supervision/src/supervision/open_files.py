"""Limit of open files and sockets of this process and its children."""

import resource

from planar import SettingsError

# A node that records everything opens about 150 files.
LEAST, USUAL = 256, 1024


def allow_open_files(wanted: int = USUAL) -> int:
    """Raise the limit to ``wanted``, as far as the system allows; return the limit."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft == resource.RLIM_INFINITY:
        return wanted
    if soft < wanted:
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    return soft


def check_open_files() -> None:
    """Make sure that nodes may open the files that they need.

    Raises:
        SettingsError: If the limit is too low.
    """
    limit = allow_open_files()
    if limit < LEAST:
        raise SettingsError(f"the limit of open files is {limit} (ulimit -n), but the nodes need {LEAST}")
