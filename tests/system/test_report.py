#!/usr/bin/env python3
"""Files in a run folder; a full disk does not stop the run and is reported."""

import contextlib
import json
import resource
import subprocess
import tempfile
import unittest
from pathlib import Path

import fastjsonschema
import numpy as np
import psutil
import rostest
from command import Command
from processes import marked_environment, processes_of, processes_with

from run_report import load_record

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = ROOT / "src/evaluation/config/result.schema.json"
FILES = {"report.html", "run.png", "record.json", "result.json", "trace.txt", "log"}
FILES |= {f"trajectory_{name}.tum" for name in ("true", "estimated", "odometry")}
FULL = 100 * 1024  # room for logs and little more, bytes
FULL_DISK = "File too large"  # error of the system for such a limit
RUN_SECONDS = 100.0


class ReportTest(unittest.TestCase):
    def test_a_run_leaves_a_result_as_documented_and_a_report(self):
        with tempfile.TemporaryDirectory() as parent:
            code, folder, output = _run(parent, "--goals", "1.0 0.5 0.0")
            self.assertEqual(code, 0, output)
            self.assertNotIn("warning", output)
            self.assertEqual({path.name for path in folder.iterdir()}, FILES)
            result = _checked_result(folder)
            self.assertEqual(result["missing"], [])
            record = load_record(folder)
            true, estimated = (
                np.loadtxt(folder / f"trajectory_{name}.tum") for name in ("true", "estimated")
            )
        print(f"localization error {result['localization_error']}, {len(record.truth)} true poses")
        self.assertLess(result["localization_error"]["max"], 0.25)
        self.assertGreater(len(record.goals), 0)
        self.assertGreater(len(record.plans), 0)
        self.assertIsNotNone(record.grid)
        stamps = set(true[:, 0])
        self.assertGreater(np.mean([stamp in stamps for stamp in estimated[:, 0]]), 0.9)

    def test_a_run_that_fails_leaves_a_result_as_documented_too(self):
        with tempfile.TemporaryDirectory() as parent:
            code, folder, output = _run(parent, "--timeout", "0.5", "--goals", "1.0 0.5 0.0")
            self.assertEqual(code, 1, output)
            self.assertFalse(_checked_result(folder)["success"])

    def test_with_a_full_disk_the_run_continues_and_reports_what_is_missing(self):
        with tempfile.TemporaryDirectory() as parent:
            script = f"ulimit -f {FULL // 1024}; exec '{ROOT}/scripts/test_navigation.sh' \"$@\""
            code, folder, output = _run(parent, "--goals", "1.0 0.5 0.0", "--gif", script=script)
            self.assertEqual(code, 0, output)
            gaps = _checked_result(folder)["missing"]
        print(f"missing: {gaps}")
        self.assertTrue([gap for gap in gaps if gap.startswith("run.gif: ")], gaps)
        self.assertIn("warning: missing: run.gif", output)

    def test_a_disk_that_fills_up_is_reported_briefly_and_fails_the_run(self):
        mark, environment = marked_environment()
        command = [ROOT / "scripts/test_navigation.sh", "--goals", "1.0 0.5 0.0; 0.0 0.5 3.0", "--output"]
        with tempfile.TemporaryDirectory() as parent:
            with Command(*command, parent, env=environment) as run:
                run.wait_for_line("goal 1 (")
                _fill_the_disk_of(mark)
                code = run.process.wait(RUN_SECONDS)
            written = [path.name for path in next(Path(parent).iterdir()).iterdir()]
        output = "".join(run.lines)
        print(output)
        self.assertEqual(code, 1)
        self.assertRegex(
            output, r"(?m)^FAILURE: result.json: cannot be written \(File too large\); .* goals reached"
        )
        about_the_disk = [line for line in run.lines if FULL_DISK in line]
        # amcl logs it, too, if it writes a checkpoint meanwhile.
        by_amcl = [line for line in about_the_disk if line.startswith("amcl: warning: no checkpoint")]
        self.assertLessEqual(len(by_amcl), 1, output)
        self.assertLessEqual(len(about_the_disk) - len(by_amcl), 2, output)
        self.assertNotIn("Traceback", output)
        self.assertEqual(written, ["log"])
        self.assertEqual(processes_with(mark), [])


def _fill_the_disk_of(mark):
    """No file of any process becomes larger, but rosout's: what is not Python would be killed by that."""
    for process, _ in processes_of(mark):
        with contextlib.suppress(psutil.NoSuchProcess):
            if process.name() != "rosout":
                process.rlimit(psutil.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))


def _run(parent, *options, script=f"exec '{ROOT}/scripts/test_navigation.sh' \"$@\""):
    """Exit code, run folder and output of a run whose folder is made in ``parent``."""
    process = subprocess.run(
        ["bash", "-c", script, "bash", "--output", parent, *options],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=100.0,
        check=False,
    )
    return process.returncode, next(Path(parent).iterdir()), process.stdout


def _checked_result(folder):
    result = json.loads((folder / "result.json").read_text())
    fastjsonschema.compile(json.loads(SCHEMA.read_text()))(result)
    return result


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "report", ReportTest)
