"""Record bags of a run with rosbag's recorder, as a separate process."""

import shutil
import signal
import subprocess
from pathlib import Path
from typing import BinaryIO, List

import roslib.packages

from supervision.errors import LaunchError
from supervision.processes import ending_with_parent
from supervision.ros.node_api import receives_all

# Topics to record: inputs of localization and mapping with the truth, or everything.
PROFILES = {
    "inputs": ["/clock", "/tf", "/tf_static", "/odom", "/scan", "/base_pose_ground_truth"],
    "all": ["--all"],
}
NODE = "bag_recorder"
SPLIT_MEGABYTES = 128
MOST_SPLITS = 8
# Time to write the index of a bag to a busy disk [s].
CLOSE_SECONDS = 60.0
FULL_BYTES = 1 << 20
# Printed by the recorder when the disk is nearly full.
PAUSED = "Disabling recording"


class RosbagProcess:
    """Writes ``folder``/<profile>_<number>.bag, at most the latest gigabyte.

    If this process is killed, the recorder closes its bag and exits.

    Args:
        profile: Name of a set of topics: inputs or all.
        folder: Where the bags are written.

    Raises:
        LaunchError: If the recorder is not installed or the folder is not writable.
    """

    def __init__(self, profile: str, folder: Path):
        self._folder = folder
        nodes = roslib.packages.find_node("rosbag", "record")
        if not nodes:
            raise LaunchError("rosbag's recorder is not installed: run scripts/setup.sh")
        command = [nodes[0], "--split", f"--size={SPLIT_MEGABYTES}", f"--max-splits={MOST_SPLITS}"]
        command += ["--repeat-latched", "--output-name", str(folder / profile), *PROFILES[profile]]
        with _opened_log(folder) as log:
            self._process = subprocess.Popen(
                [*command, f"__name:={NODE}"],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=ending_with_parent(),
            )

    def is_ready(self) -> bool:
        """Whether the recorder is connected to all publishers of the inputs, or has exited."""
        return self._process.poll() is not None or receives_all(f"/{NODE}", PROFILES["inputs"])

    def close(self) -> List[str]:
        """End the recording and return what is missing of it."""
        has_ended = self._process.poll() is not None
        missing = [f"bag: the recorder ended early: {self._cause()}"] if has_ended else []
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(CLOSE_SECONDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        missing += [f"bag: {path.name} was not closed" for path in sorted(self._folder.glob("*.bag.active"))]
        if PAUSED in (self._folder / "record.log").read_text(encoding="utf-8", errors="replace"):
            missing.append("bag: incomplete, the disk was nearly full")
        return missing

    def _cause(self) -> str:
        if shutil.disk_usage(self._folder).free < FULL_BYTES:
            return "the disk is full"
        return f"exit code {self._process.returncode}, see bag/record.log"


def _opened_log(folder: Path) -> BinaryIO:
    """Create the folder and open the recorder's log in it."""
    try:
        folder.mkdir()
        return (folder / "record.log").open("wb")
    except OSError as error:
        raise LaunchError(f"{folder}: no bags can be written there ({error.strerror})") from None
