"""rviz without a window: subscribes to what its configuration displays, and looks at nothing."""

import os
import sys
from pathlib import Path
from typing import List, Optional

import rospy

from run_project.stand_ins import without_stand_ins
from run_project.stand_ins.rviz_topics import displayed_topics

RVIZ_VARIABLE = "RUN_PROJECT_RVIZ"
OPTIONS = ("-d", "--display-config")


def main() -> None:
    """Becomes the real rviz if there is one to be shown."""
    if os.environ.get(RVIZ_VARIABLE):
        os.execvpe("rviz", ["rviz", *sys.argv[1:]], without_stand_ins(os.environ))
    rospy.init_node("rviz", anonymous=True)
    config = config_file(rospy.myargv()[1:])
    text = ""
    if config is not None:
        try:
            text = config.read_text(errors="replace")
        except OSError as error:
            print(f"[rviz] {config}: {error.strerror}; showing rviz' default", file=sys.stderr)
    for topic in sorted(displayed_topics(text)):
        print(f"[rviz] displays {topic}", flush=True)
        rospy.Subscriber(topic, rospy.AnyMsg, _ignore, queue_size=1, buff_size=1 << 20)
    rospy.spin()


def config_file(arguments: List[str]) -> Optional[Path]:
    """The configuration named on rviz' command line."""
    for option, value in zip(arguments, [*arguments[1:], ""]):
        name, has_value, inline = option.partition("=")
        if name in OPTIONS:
            return Path(inline if has_value else value)
    return Path(arguments[0]) if arguments and arguments[0].endswith(".rviz") else None


def _ignore(_message) -> None:
    pass
