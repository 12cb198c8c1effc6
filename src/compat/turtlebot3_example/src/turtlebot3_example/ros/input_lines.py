"""What somebody types, line by line, until there is no more or the node is asked to end."""

import sys
import time
from typing import Iterator

import rospy

from teleop_lite.terminal import Pipe

POLL_SECONDS = 0.1


def read_lines() -> Iterator[str]:
    """Reading would wait for the next key: rospy's handler of Ctrl-C interrupts nothing."""
    pipe = Pipe(sys.stdin.fileno())
    while not (rospy.is_shutdown() or pipe.is_at_end):
        yield from pipe.read().splitlines()
        time.sleep(POLL_SECONDS)
