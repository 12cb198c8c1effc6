"""Stand-in for rviz without a window: subscribes to the topics that its configuration displays."""

import os
import sys
from pathlib import Path
from typing import List, Optional

import rospy

from planar_ros.node.runner import init_node, shut_down_on_signals
from run_project.stand_ins import without_stand_ins
from run_project.stand_ins.rviz_topics import displayed_topics

RVIZ_VARIABLE = "RUN_PROJECT_RVIZ"
OPTIONS = ("-d", "--display-config")


def main() -> None:
    """Run the node ``rviz``; executes the real rviz instead if the run has ``--rviz``."""
    if os.environ.get(RVIZ_VARIABLE):
        os.execvpe("rviz", ["rviz", *sys.argv[1:]], without_stand_ins(os.environ))
    shut_down_on_signals()  # roslaunch and the run both send one
    init_node("rviz", anonymous=True)
    config = config_file(rospy.myargv()[1:])
    text = ""
    if config is not None:
        try:
            text = config.read_text(errors="replace")
        except OSError as error:
            print(f"[rviz] {config}: {error.strerror}; using an empty configuration", file=sys.stderr)
    for topic in sorted(displayed_topics(text)):
        print(f"[rviz] displays {topic}", flush=True)
        rospy.Subscriber(topic, rospy.AnyMsg, _ignore, queue_size=1, buff_size=1 << 20)
    rospy.spin()


def config_file(arguments: List[str]) -> Optional[Path]:
    """The configuration file in the command line of rviz."""
    for option, value in zip(arguments, [*arguments[1:], ""]):
        name, has_value, inline = option.partition("=")
        if name in OPTIONS:
            return Path(inline if has_value else value)
    return Path(arguments[0]) if arguments and arguments[0].endswith(".rviz") else None


def _ignore(_message) -> None:
    pass
