"""The command that plays a recording to localization or mapping and measures what they make of it."""

import os
from argparse import Namespace
from typing import Optional

import rospy
from std_msgs.msg import String

from home_service.bag_files import LASER_SCAN, Recording
from home_service.judging.verdict import Verdict
from home_service.ros.bags.player import BROKEN, ENDED
from home_service.ros.mapping import save_map
from home_service.ros.run import Run
from planar import load_map
from planar_ros.bags.scan_log import BagError


def replay(options: Namespace) -> int:
    options.places = {}
    recording = Recording(options.bags)
    if options.estimator == "amcl":
        load_map(options.map)  # so that a mistake is told before anything is started
    if options.estimator != "recorded" and not recording.topics_of(LASER_SCAN):
        there = ", ".join(sorted(recording.types)) or "none"
        raise BagError(f"{recording.paths[0]}: no laser scans; topics: {there}")
    x, y, yaw = options.start
    arguments = {
        "bags": os.pathsep.join(str(path.resolve()) for path in recording.paths),
        "estimator": options.estimator,
        "map_file": options.map.resolve(),
        "x": x,
        "y": y,
        "yaw": yaw,
    }
    with Run(options, "replay.launch", **arguments) as run:
        run.missing += recording.gaps
        failure = _play(run)
        if failure is None and options.estimator == "slam":
            run.display.say(f"map saved in {save_map(run, options.save)}")
        seconds = recording.end - recording.start
        verdict = Verdict(failure is None, failure or f"{seconds:.1f} s replayed")
        return run.conclude(verdict, bags=[str(path) for path in recording.paths])


def _play(run: Run) -> Optional[str]:
    """Waits for the end of the recording; why it did not come, or None."""
    told = [""]
    rospy.Subscriber("bag_player/state", String, lambda message: told.append(message.data), queue_size=10)
    failure = run.watch(lambda: told[-1].startswith((ENDED, BROKEN)))
    return failure or (told[-1] if told[-1].startswith(BROKEN) else None)
