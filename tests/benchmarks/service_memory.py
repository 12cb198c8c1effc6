#!/usr/bin/env python3
"""Memory and journal of a service that runs for many days, without physics.

python3 tests/benchmarks/service_memory.py [--days 10] [--requests 60]

One process with service, journal and a robot without physics runs day after day. After each day the resident
memory of the process and the size of the journal are printed. Exit code 1 if the memory grows by more than
1 % after the first day.
"""

import argparse
import gc
import sys
import tempfile
from pathlib import Path

import numpy as np
from service_days import DOCK, ENERGY, MIDNIGHT, make_site

from service.day.day_run import DayRun
from service.day.kinematic_robot import KinematicRobot, KinematicSettings
from service.day.requests_by_hour import DayGenerator, DaySettings
from service.journal import Journal
from service.request_service import RequestService
from service.requests.calendar_times import DAY

LARGEST_GROWTH = 0.01


def resident_bytes():
    """Return the resident memory of this process."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * 4096


def main():
    """Run the days."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--days", type=int, default=10)
    parser.add_argument("--requests", type=int, default=60)
    options = parser.parse_args()
    site, rng = make_site(), np.random.default_rng(3)
    generator = DayGenerator(list(site.places), rng, DaySettings(requests=options.requests))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "journal.db"
        journal = Journal(path)
        service = RequestService(site, find_ended=journal.ended_task)
        robot = KinematicRobot(site.model.travel, DOCK, rng, KinematicSettings(energy=ENERGY))
        memory = []
        for day in range(options.days):
            begin = MIDNIGHT + day * DAY
            run = DayRun(service, robot, generator.requests(begin), begin, journal.store)
            done = len(run.run(begin + DAY).ended)
            del run
            gc.collect()
            memory.append(resident_bytes())
            size = sum(each.stat().st_size for each in path.parent.iterdir())
            print(
                f"day {day + 1}: {done} ended, {memory[-1] / 1e6:.1f} MB, journal {size / 1e3:.0f} kB",
                flush=True,
            )
        journal.close()
    growth = memory[-1] / memory[0] - 1.0
    print(f"growth from day 1 to day {options.days}: {100.0 * growth:.2f} %")
    return int(growth > LARGEST_GROWTH)


if __name__ == "__main__":
    sys.exit(main())
