"""dynparam of dynamic_reconfigure, which for a server or a master that does not exist would wait for ever."""

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
    """Ends with exit code 1 if no server, or no master, answers."""
    if not rosgraph.is_master_online():
        sys.exit(f"error: no ROS master at {rosgraph.get_master_uri()}")
    sys.argv = with_timeout(sys.argv)
    roslib.load_manifest = lambda _: None  # Debian's libraries are on the path, their manifests are not
    try:
        runpy.run_path(TOOL, run_name="__main__")
    except rospy.ROSException as error:
        sys.exit(f"error: {error}")


def with_timeout(argv: List[str]) -> List[str]:
    """The command line with a time limit, unless it has one or speaks to no server."""
    has_limit = any(argument.startswith(("-t", "--timeout")) for argument in argv)
    if has_limit or len(argv) < 2 or argv[1] not in SERVER_COMMANDS:
        return argv
    return [*argv[:2], f"--timeout={TIMEOUT}", *argv[2:]]
