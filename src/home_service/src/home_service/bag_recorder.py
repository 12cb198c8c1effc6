"""Records a run into bags, by rosbag's recorder as a process of its own."""

import ctypes
import signal
import subprocess
from pathlib import Path
from typing import List

import roslib.packages

from home_service.errors import LaunchError

PROFILES = {
    "inputs": ["/clock", "/tf", "/tf_static", "/odom", "/scan", "/base_pose_ground_truth"],
    "all": ["--all"],
}
"""What is recorded: what localization and mapping work on, with the truth; or everything."""
SPLIT_MEGABYTES = 128
MOST_SPLITS = 8
CLOSE_SECONDS = 5.0
PR_SET_PDEATHSIG = 1


class BagRecorder:
    """Writes ``folder``/<profile>_<number>.bag, at most the latest gigabyte.

    Should this process be killed, the recorder closes its bag and ends. Raises LaunchError.
    """

    def __init__(self, profile: str, folder: Path):
        folder.mkdir()
        self._folder = folder
        nodes = roslib.packages.find_node("rosbag", "record")
        if not nodes:
            raise LaunchError("rosbag's recorder is not installed: run scripts/setup.sh")
        command = [nodes[0], "--split", f"--size={SPLIT_MEGABYTES}", f"--max-splits={MOST_SPLITS}"]
        command += ["--repeat-latched", "--output-name", str(folder / profile), *PROFILES[profile]]
        with (folder / "record.log").open("wb") as log:
            self._process = subprocess.Popen(
                [*command, "__name:=bag_recorder"],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=_end_with_parent,
            )

    def close(self) -> List[str]:
        """Ends the recording; returns what is missing of it."""
        missing = (
            [] if self._process.poll() is None else [f"bag: the recorder ended early{self._last_words()}"]
        )
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(CLOSE_SECONDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
        missing += [f"bag: {path.name} was not closed" for path in sorted(self._folder.glob("*.bag.active"))]
        if not missing and self._last_words("space"):
            missing.append(f"bag: {self._last_words('space')}")
        return missing

    def _last_words(self, about: str = "") -> str:
        """The last line of the recorder's log, of those ``about`` something."""
        text = (self._folder / "record.log").read_text(encoding="utf-8", errors="replace")
        lines = [line for line in text.splitlines() if about in line]
        return f": {lines[-1].strip()}" if lines else ""


def _end_with_parent() -> None:
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGINT, 0, 0, 0)
