#!/usr/bin/env python3
"""A campaign on two hosts with one scheduler gives the results of one process, bit for bit."""

import os
import subprocess
import sys
import tempfile
import time
import unittest
from dataclasses import replace
from pathlib import Path

import rostest
from network import NetworkLink

from laboratory.results.store import ResultStore
from laboratory.results.version import version
from laboratory.runner import run_scenario
from laboratory.scenario import read_scenario

ROOT = Path(__file__).resolve().parents[2]
SEEDS, PORT = range(6), 8786
SCENARIO = f"""\
world: {{file: {ROOT}/map/home.world, map: {ROOT}/map/home.yaml}}
task: {{errand: {ROOT}/map/zones.yaml}}
happens: {{people: 2}}
limits: {{seconds: 4}}
"""
START_SECONDS, CAMPAIGN_SECONDS = 90.0, 150.0
# Prints the addresses of all workers.
LIST_WORKERS = """\
import sys
from distributed import Client
print(*Client(sys.argv[1], timeout=5).scheduler_info(n_workers=-1)["workers"])
"""


@unittest.skipUnless(os.geteuid() == 0, "only root can make network namespaces")
class LaboratoryOnTwoHostsTest(unittest.TestCase):
    def test_two_hosts_give_the_results_of_one_process(self):
        with tempfile.TemporaryDirectory() as name, NetworkLink() as link:
            folder, scheduler = Path(name), f"tcp://{link.desk.address}:{PORT}"
            (folder / "errand.yaml").write_text(SCENARIO)
            options = ("--host", link.desk.address, "--port", str(PORT), "--no-dashboard")
            link.desk.start(link.desk, sys.executable, "-m", "distributed.cli.dask_scheduler", *options)
            for host in (link.desk, link.robot):
                options = ("--nthreads", "1", "--host", host.address, "--no-dashboard", "--no-nanny")
                worker = (sys.executable, "-m", "distributed.cli.dask_worker", scheduler, *options)
                host.start(link.desk, *worker, "--local-directory", str(folder / host.name))
            self.wait_for_workers(link, scheduler)
            words = ("errand.yaml", "--seeds", "0-5", "--scheduler", scheduler, "--output", ".")
            command = (sys.executable, "-m", "laboratory", "evaluate", *words)
            campaign = link.desk.start(link.desk, *command, folder=folder)
            self.assertEqual(campaign.wait(CAMPAIGN_SECONDS), 0)
            self.assertEqual(self.results_in(folder), self.results_here(folder))

    def wait_for_workers(self, link, scheduler):
        """Wait until each host has a worker."""
        deadline, workers = time.monotonic() + START_SECONDS, ""
        while time.monotonic() < deadline:
            ask = ("ip", "netns", "exec", link.desk.name, sys.executable, "-c", LIST_WORKERS, scheduler)
            workers = subprocess.run(ask, capture_output=True, text=True, timeout=START_SECONDS).stdout
            if link.desk.address in workers and link.robot.address in workers:
                return
        self.fail(f"not both workers connected within {START_SECONDS:g} s: {workers or 'none'}")

    def results_in(self, folder):
        store = ResultStore(folder / "results.sqlite")
        results = store.results(read_scenario(folder / "errand.yaml").digest(), version())
        store.close()
        return [replace(result, wall_seconds=0.0) for result in results]

    def results_here(self, folder):
        scenario = read_scenario(folder / "errand.yaml")
        return [replace(run_scenario(scenario, seed), wall_seconds=0.0) for seed in SEEDS]


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "laboratory_two_hosts", LaboratoryOnTwoHostsTest)
