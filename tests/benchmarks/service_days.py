#!/usr/bin/env python3
"""Days of service without physics: the plan against two baselines and an oracle.

python3 tests/benchmarks/service_days.py [--days 20] [--first-seed 1000] [--requests 60] [--slack 1 15]

All schedulers get the same requests and the same chance. Drives differ from the plan (log-normal, 15 %), 1 %
of drives and 2 % of dockings fail. The battery lasts an hour of driving. The baselines are first come, first
served and earliest deadline first, both charging below 30 %. The oracle knows all requests of the day in
advance and is relaxed: it may interrupt a request at no cost, needs no drive to where a request begins, no
charging, and drives as planned. The largest set of requests that it keeps is computed exactly, so no schedule
keeps more unless its drives are faster than planned. Counted are the deadlines that were kept, those of them
that the oracle keeps as well as a share of its number, and days with an empty battery; the days on which one
scheduler keeps more are compared by an exact sign test.
"""

import argparse
import multiprocessing
import sys
from functools import partial
from math import comb
from typing import NamedTuple

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from evaluation.options import HOME_MAP, ROOT
from laboratory.statistics.summary import share
from pick_objects import load_mission
from planar import Pose2, load_map
from service.config import EnergySettings, ServiceSettings
from service.day.day_run import DayRun
from service.day.kinematic_robot import KinematicRobot, KinematicSettings
from service.day.requests_by_hour import DayGenerator, DaySettings
from service.plan.planner import FirstComeFirstServed
from service.plan.rollout import PlanningModel
from service.plan.travel_times import GridTravelTimes
from service.request_service import RequestService, Site
from service.requests.calendar_times import DAY
from service.requests.parser import Knowledge
from service.requests.steps import Drive, Pause, PickUp, SetDown

MIDNIGHT, DOCK = 1796083200.0, Pose2(0.5, -3.0)
ENERGY = EnergySettings(drive_hours=1.0, stand_hours=4.0, charge_hours=1.0)


class EarliestDeadlineFirst(FirstComeFirstServed):
    """Baseline: the earliest deadline first, charging below a threshold up to the full."""

    def plan(self, jobs, around, start):
        """Return the jobs in the order of their deadlines, those without one last."""
        ordered = sorted(jobs, key=lambda job: float("inf") if job.deadline is None else job.deadline)
        return super().plan(ordered, around, start)


SCHEDULERS = {
    "plan": None,
    "first come": FirstComeFirstServed(),
    "earliest deadline": EarliestDeadlineFirst(),
}


class Day(NamedTuple):
    """What came of a day: by scheduler, and what the oracle keeps."""

    kept: dict
    empty: dict
    lowest: dict
    due: int
    oracle: int


def make_site():
    """Return the home."""
    places = dict(load_mission(ROOT / "map/mission.yaml").places)
    model = PlanningModel(GridTravelTimes(load_map(HOME_MAP)), ENERGY, DOCK)
    return Site(places, model, Knowledge(tuple(places), True))


def run_day(options, seed):
    """Return what came of a day."""
    site, settings = make_site(), DaySettings(requests=options.requests, slack_minutes=tuple(options.slack))
    documents = DayGenerator(list(site.places), np.random.default_rng(seed), settings).requests(MIDNIGHT)
    records, robots = {}, {}
    for name, planner in SCHEDULERS.items():
        chance = np.random.default_rng([seed, 1])
        robots[name] = KinematicRobot(site.model.travel, DOCK, chance, KinematicSettings(energy=ENERGY))
        service = RequestService(site, planner=planner)
        records[name] = DayRun(service, robots[name], documents, MIDNIGHT).run(MIDNIGHT + DAY + 3600.0)
    return Day(
        {name: len(record.kept) for name, record in records.items()},
        {name: robot.empty_at is not None for name, robot in robots.items()},
        {name: record.lowest_charge for name, record in records.items()},
        len(records["plan"].with_deadline),
        kept_by_oracle(records["plan"].with_deadline, site),
    )


def kept_by_oracle(tasks, site):
    """Return the largest number of tasks that a preemptive schedule without drives in between keeps.

    A set of tasks can be kept if and only if, for each pair of a release and a deadline, the tasks released
    and due between them last no longer than the time between (Horn, 1974).
    """
    if not tasks:
        return 0
    release = np.array([task.request.release for task in tasks])
    deadline = np.array([task.request.deadline for task in tasks])
    seconds = np.array([shortest_seconds(task, site) for task in tasks])
    rows, limits = [], []
    for begin in np.unique(release):
        for end in np.unique(deadline[deadline > begin]):
            rows.append(np.where((release >= begin) & (deadline <= end), seconds, 0.0))
            limits.append(end - begin)
    found = milp(
        -np.ones(len(tasks)),
        constraints=LinearConstraint(np.array(rows), -np.inf, np.array(limits)),
        integrality=np.ones(len(tasks)),
        bounds=Bounds(0, (seconds <= deadline - release).astype(float)),
    )
    return round(-found.fun)


def shortest_seconds(task, site):
    """Return how long a task takes from its first place on [s]."""
    settings, at, seconds = ServiceSettings(), None, 0.0
    for step in task.request.description.steps():
        if isinstance(step, Drive):
            pose = site.places[step.place].pose
            seconds += 0.0 if at is None else site.model.travel.seconds(at, pose)
            at = pose
        seconds += {PickUp: settings.pickup_seconds, SetDown: settings.dropoff_seconds}.get(type(step), 0.0)
        seconds += step.seconds if isinstance(step, Pause) else 0.0
    return seconds


def sign_test(better, worse):
    """Return the two-sided p-value of a sign test."""
    count = better + worse
    tail = sum(comb(count, number) for number in range(min(better, worse) + 1)) / 2**count
    return min(1.0, 2.0 * tail)


def main():
    """Run the days."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--days", type=int, default=20)
    parser.add_argument("--first-seed", type=int, default=1000)
    parser.add_argument("--requests", type=int, default=60)
    parser.add_argument("--slack", type=float, nargs=2, default=(1.0, 15.0), metavar="MINUTES")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    seeds = range(options.first_seed, options.first_seed + options.days)
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        days = []
        for number, day in enumerate(pool.imap(partial(run_day, options), seeds), 1):
            days.append(day)
            if number % 10 == 0:
                print(f"{number} days", file=sys.stderr, flush=True)
    due, oracle = (sum(getattr(day, name) for day in days) for name in ("due", "oracle"))
    print(f"{len(days)} days, {due} deadlines; the oracle keeps {oracle}")
    for name in SCHEDULERS:
        kept = sum(day.kept[name] for day in days)
        interval = share(kept, due)
        print(
            f"{name}: {kept} kept ({100.0 * kept / due:.1f} %, 95 % interval {100.0 * interval.low:.1f} to "
            f"{100.0 * interval.high:.1f} %), {100.0 * kept / oracle:.1f} % of the oracle's, "
            f"{sum(day.empty[name] for day in days)} days with an empty battery, "
            f"lowest charge {100.0 * min(day.lowest[name] for day in days):.0f} %"
        )
        if name != "plan":
            differences = [day.kept["plan"] - day.kept[name] for day in days]
            better, worse = (sum(sign * each > 0 for each in differences) for sign in (1, -1))
            p_value = sign_test(better, worse)
            print(f"  the plan is better on {better} days, worse on {worse}, sign test p = {p_value:.3g}")
    return int(any(day.empty["plan"] for day in days))


if __name__ == "__main__":
    sys.exit(main())
