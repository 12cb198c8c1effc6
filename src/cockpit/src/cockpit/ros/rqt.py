"""The cockpit under the names of rqt's programs; each opens the corresponding tool."""

import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import rospy

from planar import PlanarError
from supervision.interruption import leave

# Programs that open the cockpit without a tool.
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
    """Run the program; exit code 2 for an unknown tool or without viser."""
    if find_spec("viser") is None:
        sys.exit(_complain("the cockpit is not installed; run ./scripts/setup.sh --web"))
    from cockpit.ros.node import FREE_PORT, serve

    arguments = rospy.myargv()[1:]
    try:
        tool, words = chosen(Path(sys.argv[0]).name, arguments)
        leave(serve(FREE_PORT, tool, words))
    except PlanarError as error:
        sys.exit(_complain(str(error)))


def chosen(program: str, arguments: List[str]) -> Tuple[Optional[str], Tuple[str, ...]]:
    """Return the tool that a command line of rqt selects.

    Args:
        program: Name of the program, ``rqt`` or one such as ``rqt_graph``.
        arguments: Its arguments; ``rqt -s rqt_graph`` is ``rqt_graph``.

    Returns:
        Name of the tool, None for the page alone, and the tool's arguments.

    Raises:
        PlanarError: The tool is unknown.
    """
    words = list(arguments)
    for option in STANDALONE:
        if option in words:
            at = words.index(option)
            program = words[at + 1] if at + 1 < len(words) else ""
            del words[at : at + 2]
    if program not in TOOLS and program not in WHOLE:
        raise PlanarError(f"unknown program '{program}'; expected one of {', '.join(sorted(TOOLS))}")
    return TOOLS.get(program), tuple(word for word in words if not word.startswith("-"))


def _complain(text: str) -> int:
    print(f"error: {text}", file=sys.stderr)
    return 2
