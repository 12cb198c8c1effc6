"""The cockpit as a child process of a run."""

import sys
from pathlib import Path
from typing import Mapping, Optional, Sequence

from cockpit.errors import CockpitError, PortError
from cockpit.page_program import PageProgram

# Default address of the page.
FREE_PORT = "127.0.0.1:0"


class CockpitProcess(PageProgram):
    """Starts the cockpit for the graph of ``ROS_MASTER_URI``, whose master may start later.

    Args:
        where: [ADDRESS:]PORT of the page.
        log: Log file.
        environment: Environment variables; None to inherit them.
        tool: Name of a tool that is opened first.
        prefix: Words in front of the command, such as those of a sandbox.

    Raises:
        PortError: If the page cannot be served at ``where``.
        CockpitError: If the process does not start.
    """

    def __init__(
        self,
        where: str,
        log: Path,
        environment: Optional[Mapping[str, str]] = None,
        tool: Optional[str] = None,
        prefix: Sequence[str] = (),
    ):
        opened = [] if tool is None else ["--tool", tool]
        command = [*prefix, sys.executable, "-m", "cockpit.ros.node", "--web-port", where, *opened]
        super().__init__(command, "cockpit", log, environment)
        try:
            self.url = self.wait_for_url()
        except PortError:
            raise
        except CockpitError:
            raise CockpitError(f"the cockpit did not start, see {log}") from None
