"""Lines from standard input that a shutdown of the node interrupts."""

import sys
import time
from typing import Iterator

import rospy

from teleop_lite.terminal import Pipe

POLL_SECONDS = 0.1


def read_lines() -> Iterator[str]:
    """Lines from standard input until its end or the node's shutdown.

    Polls, because rospy's SIGINT handler does not interrupt a blocking read.
    """
    pipe = Pipe(sys.stdin.fileno())
    while not (rospy.is_shutdown() or pipe.is_at_end):
        yield from pipe.read().splitlines()
        time.sleep(POLL_SECONDS)
