"""Playback of a recording to localization or mapping."""

from pathlib import Path
from typing import Dict, Optional, Sequence

from evaluation.consumers.referee import Referee
from evaluation.consumers.run_recorder import RunRecorder
from evaluation.event_stream import Latest
from evaluation.events import PlaybackUpdated
from evaluation.options import LaunchPlan, RunOptions
from evaluation.ros.run import Run
from evaluation.verdict import Verdict
from home_service.ros.bags import BROKEN, ENDED
from home_service.ros.bags.inputs import find_inputs
from home_service.ros.mapping import save_map
from planar import OCCUPIED, load_map
from planar_ros.bags.bag_reader import LASER_SCAN, BagError
from planar_ros.bags.recording import Recording
from supervision.display import Display
from supervision.interruption import raise_when_interrupted


def open_recording(paths: Sequence[Path], needs_scans: bool) -> Recording:
    """Open bags.

    Args:
        paths: Bags, or folders of them or of runs.
        needs_scans: Laser scans are required.

    Raises:
        BagError: If a bag cannot be read, or scans are missing.
    """
    raise_when_interrupted()  # a broken bag is repaired in a temporary copy, which must be deleted
    recording = Recording(paths)
    if needs_scans and not recording.topics_of(LASER_SCAN):
        there = ", ".join(sorted(recording.types)) or "none"
        raise BagError(f"{recording.paths[0]}: no laser scans; topics: {there}")
    return recording


def inputs_of(recording: Recording, needs_odometry: bool) -> Dict[str, str]:
    """Find and print the frames and topics of a recording.

    Returns:
        Arguments of replay.launch.

    Raises:
        BagError: They cannot be found, or odometry is missing.
    """
    inputs = find_inputs(recording)
    Display().print(str(inputs))
    if needs_odometry and not inputs.frames.has_odometry:
        path = recording.paths[0]
        raise BagError(f"{path}: no odometry: only a robot with odometry can be localized; try --with slam")
    return inputs.launch_arguments()


def replay(
    options: RunOptions, launch: LaunchPlan, recording: Recording, saves_map: bool, stem: Optional[Path]
) -> int:
    """Run the graph that plays a recording to its end.

    Args:
        options: Options of the command.
        launch: What to launch.
        recording: The recording.
        saves_map: Save the map at the end.
        stem: Where to save it; None: into the run folder.

    Returns:
        Exit code.
    """
    display = Display()
    playback, referee = Latest(PlaybackUpdated), Referee({}, display.print)
    with Run(options, launch, referee, RunRecorder({}), display, [playback]) as run:
        run.result.missing += recording.truncations
        failure = _play(run, playback)
        if failure is None and saves_map:
            path = save_map(run, stem)
            display.print(f"map saved in {path}")
            if not (load_map(path).cells == OCCUPIED).any():
                failure = "no useful map: no scan has shown an obstacle"
        verdict = Verdict(failure is None, failure or f"{recording.end - recording.start:.1f} s replayed")
        return run.conclude(verdict, bags=[str(path) for path in recording.paths])


def _play(run: Run, playback: "Latest[PlaybackUpdated]") -> Optional[str]:
    """Wait for the end of the recording; return why it was not reached, or None."""

    def state() -> str:
        return "" if playback.event is None else playback.event.text

    failure = run.watch(lambda: state().startswith((ENDED, BROKEN)))
    return failure or (state() if state().startswith(BROKEN) else None)
