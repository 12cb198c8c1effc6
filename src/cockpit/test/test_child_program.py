"""Programs that are started at the page."""

import os
import subprocess
import sys
import time

from cockpit.child_program import ChildProgram

SECONDS = 20.0
TOUCHES = (
    "import sys, time; from pathlib import Path\nwhile True: Path(sys.argv[1]).touch(); time.sleep(0.01)"
)
WRITES_AT_CTRL_C = """
import sys, time; from pathlib import Path
path = Path(sys.argv[1])
try:
    path.write_text("recording")
    time.sleep(60)
except KeyboardInterrupt:
    path.write_text("whole")
"""
STARTER = """
import sys, threading, time
from cockpit.child_program import ChildProgram
threading.Thread(target=lambda: (ChildProgram([sys.executable, *sys.argv[1:]]), time.sleep(60))).start()
"""


def test_it_ends_with_who_has_started_it_in_whatever_thread(tmp_path):
    sign = tmp_path / "alive"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    starter = subprocess.Popen([sys.executable, "-c", STARTER, "-c", TOUCHES, str(sign)], env=environment)
    wait_until(sign.exists)
    starter.kill()
    starter.wait()
    wait_until(lambda: time.time() - sign.stat().st_mtime > 1.0)


def test_it_is_ended_as_by_ctrl_c(tmp_path):
    path = tmp_path / "file"
    program = ChildProgram([sys.executable, "-c", WRITES_AT_CTRL_C, str(path)])
    wait_until(lambda: path.exists() and path.read_text() == "recording")
    assert program.is_running and program.complaints() == []
    program.end()
    assert not program.is_running and program.complaints() == []
    assert path.read_text() == "whole"


def test_the_last_line_of_a_failed_program_is_reported():
    program = ChildProgram([sys.executable, "-c", "import sys; sys.exit('no such bag')"])
    wait_until(lambda: not program.is_running)
    assert program.complaints() == ["no such bag"]


def wait_until(is_met):
    deadline = time.monotonic() + SECONDS
    while not is_met():
        assert time.monotonic() < deadline
        time.sleep(0.05)
