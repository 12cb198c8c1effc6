"""A recording, played to localization or mapping, and what they make of it."""

from pathlib import Path
from typing import Optional, Sequence

import rospy
from std_msgs.msg import String

from home_service.judging.verdict import Verdict
from home_service.options import LaunchPlan, RunOptions
from home_service.ros.bags import BROKEN, ENDED
from home_service.ros.mapping import save_map
from home_service.ros.referee import Referee
from home_service.ros.run import Run
from home_service.ros.run_recorder import RunRecorder
from planar_ros.bags.bag import LASER_SCAN, BagError
from planar_ros.bags.recording import Recording
from supervision.display import Display
from supervision.interruption import raise_when_interrupted


def open_recording(paths: Sequence[Path], needs_scans: bool) -> Recording:
    """The bags that are named. Raises BagError, also if there are no scans where scans are needed."""
    raise_when_interrupted()  # what is broken is mended in a copy, which must not stay
    recording = Recording(paths)
    if needs_scans and not recording.topics_of(LASER_SCAN):
        there = ", ".join(sorted(recording.types)) or "none"
        raise BagError(f"{recording.paths[0]}: no laser scans; topics: {there}")
    return recording


def replay(
    options: RunOptions, launch: LaunchPlan, recording: Recording, saves_map: bool, stem: Optional[Path]
) -> int:
    """Runs the graph that plays it to its end; the map goes to ``stem`` or the run folder. The exit code."""
    display = Display()
    with Run(options, launch, Referee({}, display.print), RunRecorder({}), display) as run:
        run.result.missing += recording.gaps
        failure = _play(run)
        if failure is None and saves_map:
            display.print(f"map saved in {save_map(run, stem)}")
        verdict = Verdict(failure is None, failure or f"{recording.end - recording.start:.1f} s replayed")
        return run.conclude(verdict, bags=[str(path) for path in recording.paths])


def _play(run: Run) -> Optional[str]:
    """Waits for the end of the recording; why it did not come, or None."""
    told = [""]
    rospy.Subscriber("bag_player/state", String, lambda message: told.append(message.data), queue_size=10)
    failure = run.watch(lambda: told[-1].startswith((ENDED, BROKEN)))
    return failure or (told[-1] if told[-1].startswith(BROKEN) else None)
