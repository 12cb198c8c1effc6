"""The cockpit under the names of rqt's programs: each opens it at the tool that does the same."""

import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import rospy

from planar import PlanarError
from supervision.interruption import leave

# The whole cockpit, and its tools.
WHOLE = ("rqt", "rqt_gui", "gzclient")
TOOLS: Dict[str, str] = {
    "rqt_bag": "bag",
    "rqt_console": "console",
    "rqt_graph": "graph",
    "rqt_image_view": "images",
    "rqt_logger_level": "console",
    "rqt_plot": "plot",
    "rqt_publisher": "publisher",
    "rqt_reconfigure": "reconfigure",
    "rqt_service_caller": "services",
    "rqt_tf_tree": "frames",
    "rqt_topic": "topics",
}
STANDALONE = ("-s", "--standalone")


def main() -> None:
    """Ends with 2 if there is no such tool, or no cockpit."""
    if find_spec("viser") is None:
        sys.exit(_complain("the cockpit is not installed: ./scripts/setup.sh --web brings it"))
    from cockpit.ros.node import FREE_PORT, serve

    arguments = rospy.myargv()[1:]
    try:
        tool, words = chosen(Path(sys.argv[0]).name, arguments)
        leave(serve(FREE_PORT, tool, words))
    except PlanarError as error:
        sys.exit(_complain(str(error)))


def chosen(program: str, arguments: List[str]) -> Tuple[Optional[str], Tuple[str, ...]]:
    """The tool to open, and what it is to show. ``rqt -s rqt_graph`` is ``rqt_graph``. Raises PlanarError."""
    words = list(arguments)
    for option in STANDALONE:
        if option in words:
            at = words.index(option)
            program = words[at + 1] if at + 1 < len(words) else ""
            del words[at : at + 2]
    if program not in TOOLS and program not in WHOLE:
        raise PlanarError(f"there is no '{program}' here, only {', '.join(sorted(TOOLS))}")
    return TOOLS.get(program), tuple(word for word in words if not word.startswith("-"))


def _complain(text: str) -> int:
    print(f"error: {text}", file=sys.stderr)
    return 2
