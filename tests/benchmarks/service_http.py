#!/usr/bin/env python3
"""Measure how many requests a second the service accepts, and check that none is lost when it is killed.

python3 tests/benchmarks/service_http.py [--rate 200] [--seconds 10] [--kills 3]

Clients send requests at a fixed rate over HTTP; the service is killed with SIGKILL and started again several
times. A request without an answer is sent again under its id. At the end each request that was answered must
be in the journal, once.
"""

import argparse
import json
import multiprocessing
import os
import queue
import signal
import statistics
import sys
import tempfile
import threading
import time
from pathlib import Path

from planar import Pose2
from planar.errors import SettingsError
from planar.maps.places import NamedPlace
from service.config import ServiceSettings
from service.execution.robot import RobotInputs
from service.host import ServiceHost
from service.http.client import RequestRefusedError, ServiceClient
from service.http.server import HttpServer
from service.journal import Journal
from service.plan.rollout import PlanningModel
from service.request_service import RequestService, Site
from service.requests.parser import Knowledge

PLACES = {name: NamedPlace(name, Pose2(x, 0.0)) for name, x in (("kitchen", 0.0), ("desk", 5.0))}
THREADS, PATIENCE_SECONDS, POLL_SECONDS = 16, 60.0, 0.02


class StraightLines:
    """Times of drives along straight lines."""

    def seconds(self, start, end):
        """Return the time at 0.3 m/s [s]."""
        return start.distance_to(end) / 0.3


def serve(folder):
    """Run the service until it is killed."""
    site = Site(PLACES, PlanningModel(StraightLines()), Knowledge(tuple(PLACES)))
    settings = ServiceSettings(max_open=100_000)

    def make(journal):
        return RequestService(site, settings, journal.restore(), find_ended=journal.ended_task)

    host = ServiceHost(folder / "journal.db", make)
    HttpServer(host, folder).start()
    while True:
        host.cycle(time.time(), RobotInputs(Pose2()))
        time.sleep(POLL_SECONDS)


class Load:
    """Sends requests at a rate from several threads."""

    def __init__(self, folder, rate, count):
        self._folder, self._rate = folder, rate
        self._waiting: queue.Queue[int] = queue.Queue()
        for number in range(count):
            self._waiting.put(number)
        self.answered, self.delays, self.failed = [], [], []
        self._start = time.monotonic()
        self.threads = [threading.Thread(target=self._send) for _ in range(THREADS)]

    def run(self):
        """Start the clients."""
        self._start = time.monotonic()
        for thread in self.threads:
            thread.start()

    def _send(self):
        client = ServiceClient(self._folder)
        while True:
            try:
                number = self._waiting.get_nowait()
            except queue.Empty:
                return
            time.sleep(max(0.0, self._start + number / self._rate - time.monotonic()))
            before = time.monotonic()
            try:
                task = client.submit({"text": "go desk", "id": f"load-{number}"}, PATIENCE_SECONDS)
            except (RequestRefusedError, SettingsError) as error:
                self.failed.append(str(error))
                continue
            self.delays.append(time.monotonic() - before)
            self.answered.append(task["booking"]["id"])


def start(folder):
    """Start the service in a process; wait until it answers."""
    process = multiprocessing.get_context("spawn").Process(target=serve, args=(folder,), daemon=True)
    process.start()
    deadline = time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < deadline:
        try:
            if json.loads((folder / "service.json").read_text())["pid"] == process.pid:
                return process
        except (OSError, ValueError):
            pass
        time.sleep(POLL_SECONDS)
    raise SystemExit("error: the service did not start")


def main():
    """Run the measurement; the exit code is 0 if nothing was lost."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rate", type=float, default=200.0)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--kills", type=int, default=3)
    options = parser.parse_args()
    count = round(options.rate * options.seconds)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        process = start(folder)
        load = Load(folder, options.rate, count)
        began = time.monotonic()
        load.run()
        for number in range(options.kills):
            time.sleep(options.seconds / (options.kills + 1))
            os.kill(process.pid, signal.SIGKILL)
            process.join()
            process = start(folder)
            print(f"kill {number + 1}: {len(load.answered)} requests answered so far", flush=True)
        for thread in load.threads:
            thread.join()
        elapsed = time.monotonic() - began
        process.kill()
        process.join()
        stored = [task.id for task in Journal(folder / "journal.db").restore().tasks]
    lost = set(load.answered) - set(stored)
    delays = statistics.quantiles(load.delays, n=100)
    print(
        f"{len(load.answered)} of {count} answered in {elapsed:.1f} s: {len(load.answered) / elapsed:.0f}/s"
    )
    print(f"answer after {1000 * delays[49]:.0f} ms (median), {1000 * delays[98]:.0f} ms (99 %)")
    print(f"{len(lost)} lost, {len(stored) - len(set(stored))} doubled, {len(load.failed)} refused")
    return 1 if lost or load.failed or len(set(stored)) != count else 0


if __name__ == "__main__":
    sys.exit(main())
