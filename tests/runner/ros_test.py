"""Run one .test file in a child process: ``ros_test.py FOLDER FILE`` prints its outcome."""

import json
import os
import signal
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Dict, Optional
from xml.etree import ElementTree

from containment import ROOT, run_contained
from outcome import Outcome, failure, judge_ros_test

from supervision.processes import ending_with_parent

DEFAULT_SECONDS = 60.0  # of a <test> without time-limit
START_AND_STOP_SECONDS = 60.0  # of everything around the <test>s of a file


def time_limits(path: Path) -> Dict[str, float]:
    """Return the time limit [s] of each test of a .test file."""
    tests = ElementTree.parse(path).getroot().iter("test")
    return {test.attrib["test-name"]: float(test.get("time-limit", DEFAULT_SECONDS)) for test in tests}


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).with_suffix("").as_posix()


def log_of(folder: Path, name: str) -> Path:
    return folder / f"{name.replace('/', '.')}.log"


class RosTest:
    """Starts a .test file in a child process; logs and reports go into ``folder``."""

    def __init__(self, folder: Path, path: Path):
        self.name = name_of(path)
        command = [sys.executable, __file__, str(folder), str(path)]
        # A new session, so that it is interrupted only once and only on purpose.
        self._process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,
            preexec_fn=ending_with_parent(signal.SIGTERM),
        )

    def wait(self) -> Outcome:
        """Return the outcome; if interrupted, end the child process, which ends its own children."""
        try:
            output, _ = self._process.communicate()
        except KeyboardInterrupt:
            self._process.terminate()
            self._process.wait()
            raise
        return Outcome(**json.loads(output)) if output else failure("was terminated")


def run(folder: Path, path: Path) -> Outcome:
    limits = time_limits(path)
    log = log_of(folder, name_of(path))
    reports = log.with_suffix("")
    command = ["rostest", f"--results-base-dir={reports}", str(path)]
    limit = sum(limits.values()) + START_AND_STOP_SECONDS
    return run_contained(command, log, limit, lambda code: judge_ros_test(list(limits), reports, code))


def main(folder: str, path: str) -> Optional[int]:
    """Run a .test file, whose scripts are in the package tests/, and their helpers in tests/shared."""
    for variable, place in (("ROS_PACKAGE_PATH", "tests"), ("PYTHONPATH", "tests/shared")):
        os.environ[variable] = os.pathsep.join([str(ROOT / place), os.environ.get(variable, "")])
    try:
        print(json.dumps(asdict(run(Path(folder), Path(path)))))
    except KeyboardInterrupt:
        return 130
    return None


if __name__ == "__main__":
    # A process started in the background by a shell ignores SIGINT.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    sys.exit(main(*sys.argv[1:]))
