#!/usr/bin/env python3
"""The same seed gives the same run over the whole graph, however busy the machine is."""

import contextlib
import json
import multiprocessing
import subprocess
import tempfile
import unittest
from pathlib import Path

import rostest

ROOT = Path(__file__).resolve().parents[2]
RUN_SECONDS = 150.0


class RepeatedTest(unittest.TestCase):
    def test_a_mission_is_repeatable_under_load(self):
        self._repeats("home_service.sh", "--seed", "5")

    def test_a_map_is_repeatable_under_load(self):
        """Exploration of a small world, which takes little time."""
        self._repeats("map_home.sh", "--seed", "5", "--world", str(ROOT / "tests/system/two_rooms.world"))

    def _repeats(self, *command):
        with tempfile.TemporaryDirectory() as parent:
            done = _script(*command, "--output", parent)
            self.assertEqual(done.returncode, 0, done.stdout)
            folder = next(Path(parent).iterdir())
            result = json.loads((folder / "result.json").read_text(encoding="utf-8"))
            self.assertEqual(result["not_repeatable_because"], [])
            self.assertTrue(result["repeatable"])
            with _busy():
                again = _script("reproduce.sh", str(folder))
        self.assertEqual(again.returncode, 0, again.stdout)
        self.assertIn(f"hash {result['hash'][:16]}", again.stdout)

    def test_a_folder_without_a_run_is_refused_in_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            refused = _script("reproduce.sh", folder)
        self.assertEqual(refused.returncode, 2, refused.stdout)
        self.assertIn(f"{folder}/result.json: No such file or directory", refused.stdout)
        self.assertNotIn("Traceback", refused.stdout)


@contextlib.contextmanager
def _busy():
    """Keeps every core busy."""
    stop = multiprocessing.Event()
    workers = [
        multiprocessing.Process(target=_work, args=(stop,), daemon=True)
        for _ in range(multiprocessing.cpu_count())
    ]
    for worker in workers:
        worker.start()
    try:
        yield
    finally:
        stop.set()
        for worker in workers:
            worker.join()


def _work(stop):
    while not stop.is_set():
        sum(range(100_000))


def _script(name, *arguments):
    return subprocess.run(
        [str(ROOT / "scripts" / name), *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=RUN_SECONDS,
        text=True,
        check=False,
    )


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "repeated", RepeatedTest)
