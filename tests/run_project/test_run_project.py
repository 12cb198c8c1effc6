#!/usr/bin/env python3
"""A project in C++ with xterm runs unmodified: a real actionlib client uses move_base of this workspace."""

import hashlib
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import uuid
from pathlib import Path

import rostest
from processes import processes_with
from projects import remove_work_folder

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/run_project.sh"
SAMPLE = Path(__file__).resolve().parent / "sample_project"
RUN_SECONDS = 480.0
EXIT_SECONDS = 30.0


class WithoutCompilerTest(unittest.TestCase):
    """As in the container image, where no compiler can be installed."""

    def test_a_project_is_rejected_with_the_missing_tool(self):
        refused = subprocess.run(
            [str(SCRIPT), str(SAMPLE)], capture_output=True, text=True, timeout=RUN_SECONDS, check=False
        )
        self.assertEqual(refused.returncode, 1)
        self.assertRegex(refused.stderr, r"error: .*(missing|read-only)")
        self.assertNotIn("Traceback", refused.stderr)


class RunProjectTest(unittest.TestCase):
    """The tests share a checkout, so that it is compiled once."""

    @classmethod
    def setUpClass(cls):
        cls._folder = Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls._folder)
        cls._checkout = cls._folder / f"user_project_{uuid.uuid4().hex}"
        shutil.copytree(SAMPLE, cls._checkout)
        cls.addClassCleanup(remove_work_folder, cls._checkout)

    def setUp(self):
        self._mark = uuid.uuid4().hex
        self._output = Path(tempfile.mkdtemp(dir=self._folder))

    def test_a_project_is_built_run_and_judged_without_changing_it(self):
        hash_before = _hash_of(self._checkout)
        run = self._start(self._checkout)
        output, _ = run.communicate(timeout=RUN_SECONDS)
        self.assertEqual(run.returncode, 0, output)
        result = json.loads(next(self._output.glob("*/result.json")).read_text())
        self.assertEqual([goal["status"] for goal in result["goals"]], ["succeeded", "succeeded"])
        self.assertEqual(result["markers"], ["shown at (1.00, 0.50)", "hidden", "shown at (-0.50, 0.50)"])
        self.assertEqual(result["collisions"], [])
        self.assertGreater(result["distance_driven"], 2.0)
        rules = [line.partition(": ")[0] for line in result["pace"]]
        self.assertLessEqual({"add_markers", "pick_objects"}, set(rules), "each of its nodes has a rule")
        self.assertEqual(_hash_of(self._checkout), hash_before)
        self.assertEqual(processes_with(self._mark), [])
        self.assertEqual(_mounts_of(self._checkout), [])

    def test_an_interrupted_run_leaves_nothing_behind(self):
        run = self._start(self._checkout, "--speed", "1")
        while "shown at" not in run.stdout.readline() and run.poll() is None:
            pass
        run.send_signal(signal.SIGINT)
        started = time.monotonic()
        run.communicate(timeout=EXIT_SECONDS)
        print(f"ended {time.monotonic() - started:.1f} s after the interrupt")
        self.assertEqual(run.returncode, 130)
        self.assertEqual(processes_with(self._mark), [])

    def test_a_killed_run_leaves_nothing_behind(self):
        run = self._start(self._checkout, "--speed", "1")
        while "shown at" not in run.stdout.readline() and run.poll() is None:
            pass
        run.kill()
        started = time.monotonic()
        while processes_with(self._mark) and time.monotonic() - started < EXIT_SECONDS:
            time.sleep(0.1)
        print(f"nothing left {time.monotonic() - started:.1f} s after it was killed")
        self.assertEqual(processes_with(self._mark), [])

    def test_an_invalid_path_is_rejected_in_one_line(self):
        for path, words in ((self._output / "nowhere", "no such folder"), (self._output, "")):
            with self.subTest(path=path):
                run = self._start(path)
                output, _ = run.communicate(timeout=EXIT_SECONDS)
                self.assertEqual(run.returncode, 2)
                self.assertRegex(output, rf"(?m)^error: .*{words}")
                self.assertNotIn("Traceback", output)

    def test_the_last_line_of_a_failing_script_is_the_reason(self):
        script = self._checkout / "catkin_ws/src/scripts/home_service.sh"
        self.addCleanup(script.write_text, script.read_text())
        script.write_text("#!/bin/sh\necho give me the workspace\nexit 3\n")
        output, _ = self._start(self._checkout).communicate(timeout=RUN_SECONDS)
        self.assertIn("FAILURE: the script ended with exit code 3: give me the workspace;", output)

    def _start(self, path, *options):
        return subprocess.Popen(
            [str(SCRIPT), str(path), "--output", str(self._output), *options],
            env={**os.environ, "RUN_PROJECT_TEST": self._mark},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )


def _hash_of(folder):
    """Hash of all names, modes, times and contents."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        status = path.lstat()
        digest.update(f"{path.relative_to(folder)} {status.st_mode} {status.st_mtime_ns}\n".encode())
        if path.is_file():
            digest.update(path.read_bytes())
    return digest.hexdigest()


def _mounts_of(checkout):
    """Mounts of the checkout, or of the work folder named after it; other programs mount as well."""
    return [line for line in Path("/proc/self/mounts").read_text().splitlines() if checkout.name in line]


if __name__ == "__main__":
    can_build = shutil.which("g++") is not None
    rostest.rosrun("home_service_tests", "run_project", RunProjectTest if can_build else WithoutCompilerTest)
