"""dynparam of dynamic_reconfigure with a time limit for a missing server or master."""

import runpy
import sys
from typing import List

import rosgraph
import roslib
import rospy

TOOL = "/usr/lib/dynamic_reconfigure/dynparam"
TIMEOUT = 5.0  # s
SERVER_COMMANDS = ("dump", "get", "load", "set", "set_from_parameters")


def main() -> None:
    """Run dynparam; exit code 1 if the server or the master does not respond."""
    if not rosgraph.is_master_online():
        sys.exit(f"error: no ROS master at {rosgraph.get_master_uri()}")
    sys.argv = with_timeout(sys.argv)
    roslib.load_manifest = lambda _: None  # Debian installs the libraries without manifests
    try:
        runpy.run_path(TOOL, run_name="__main__")
    except rospy.ROSException as error:
        sys.exit(f"error: {error}")


def with_timeout(argv: List[str]) -> List[str]:
    """Add a time limit to a command that calls a server, unless it has one."""
    has_limit = any(argument.startswith(("-t", "--timeout")) for argument in argv)
    if has_limit or len(argv) < 2 or argv[1] not in SERVER_COMMANDS:
        return argv
    return [*argv[:2], f"--timeout={TIMEOUT}", *argv[2:]]
