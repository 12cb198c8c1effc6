"""The manners of a node: how it starts, fails and ends."""

import sys
from typing import Callable

import rospy

from planar import PlanarError


def run(node_name: str, start: Callable[[], object]) -> None:
    """Names the node, calls ``start`` and stays until shutdown; what ``start`` returns is kept alive.

    A PlanarError during the start is a user's mistake: one line on stderr, exit code 2.
    """
    rospy.init_node(node_name)
    try:
        node = start()
        rospy.spin()
        del node
    except rospy.ROSInterruptException:
        pass
    except PlanarError as error:
        fail(str(error))


def fail(text: str, exit_code: int = 2) -> None:
    """Says why on stderr, in one line, and ends the node."""
    print(f"[{rospy.get_name()}] error: {text}", file=sys.stderr, flush=True)
    rospy.signal_shutdown(text)
    sys.exit(exit_code)
