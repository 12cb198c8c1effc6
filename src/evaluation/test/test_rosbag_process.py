"""End of the bag recorder."""

import signal
import time

from evaluation.ros import rosbag_process
from evaluation.ros.rosbag_process import RosbagProcess

START_SECONDS = 30.0


def test_a_recorder_that_does_not_exit_is_killed_before_its_bags_are_checked(tmp_path, monkeypatch):
    recorder, bags = tmp_path / "record", tmp_path / "bag"
    recorder.write_text(f"#!/bin/sh\ntrap '' INT\ntouch {bags}/inputs_0.bag.active\nexec sleep 60\n")
    recorder.chmod(0o755)
    monkeypatch.setattr(rosbag_process.roslib.packages, "find_node", lambda *_: [str(recorder)])
    monkeypatch.setattr(rosbag_process, "CLOSE_SECONDS", 0.2)
    process = RosbagProcess("inputs", bags)
    deadline = time.monotonic() + START_SECONDS
    while not (bags / "inputs_0.bag.active").exists() and time.monotonic() < deadline:
        time.sleep(0.01)
    assert process.close() == ["bag: inputs_0.bag.active was not closed"]
    assert process._process.returncode == -signal.SIGKILL
