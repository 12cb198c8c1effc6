"""Stand-in for nodelet: a relay instead of the velocity smoother; TurtleBot's others are not needed."""

import os
import sys
from typing import Dict, List

SMOOTHER = "VelocitySmootherNodelet"


def command_for(arguments: List[str]) -> List[str]:
    """Command that replaces ``nodelet`` with these arguments: a topic relay, or a process that sleeps."""
    words = [word for word in arguments if ":=" not in word]
    if not any(word.endswith(SMOOTHER) for word in words):
        return ["sleep", "infinity"]
    remaps: Dict[str, str] = dict(word.split(":=", 1) for word in arguments if ":=" in word)
    name = remaps.get("__name", "velocity_smoother")
    ends = [_remapped(remaps, name, topic) for topic in ("raw_cmd_vel", "smooth_cmd_vel")]
    return ["rosrun", "topic_tools", "relay", *ends, f"__name:={name}"]


def _remapped(remaps: Dict[str, str], node: str, topic: str) -> str:
    for name in (f"{node}/{topic}", f"/{node}/{topic}", f"~{topic}"):
        if name in remaps:
            return remaps[name]
    return f"{node}/{topic}"


def main() -> None:
    """Execute the replacing command."""
    command = command_for(sys.argv[1:])
    os.execvp(command[0], command)
