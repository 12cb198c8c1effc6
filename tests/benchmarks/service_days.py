#!/usr/bin/env python3
"""Days of service without physics: the plan against first come, first served with threshold charging.

python3 tests/benchmarks/service_days.py [--days 20] [--first-seed 1000] [--requests 60]

Both schedulers get the same requests and the same chance. Drives differ from the plan (log-normal, 15 %), 1 %
of drives and 2 % of dockings fail. The battery lasts an hour of driving. Counted are the deadlines that were
kept, and days with an empty battery; the days on which one scheduler keeps more are compared by an exact sign
test.
"""

import argparse
import sys
from math import comb

import numpy as np

from evaluation.options import HOME_MAP, ROOT
from pick_objects import load_mission
from planar import Pose2, load_map
from service.config import EnergySettings
from service.day.day_run import DayRun
from service.day.kinematic_robot import KinematicRobot, KinematicSettings
from service.day.requests_by_hour import DayGenerator, DaySettings
from service.plan.planner import FirstComeFirstServed
from service.plan.rollout import PlanningModel
from service.plan.travel_times import GridTravelTimes
from service.request_service import RequestService, Site
from service.requests.calendar_times import DAY
from service.requests.parser import Knowledge

MIDNIGHT, DOCK = 1796083200.0, Pose2(0.5, -3.0)
ENERGY = EnergySettings(drive_hours=1.0, stand_hours=4.0, charge_hours=1.0)


def run_day(site, seed, requests, planner):
    """Return the record of a day, and its robot."""
    settings = DaySettings(requests=requests, slack_minutes=(1.0, 15.0))
    documents = DayGenerator(list(site.places), np.random.default_rng(seed), settings).requests(MIDNIGHT)
    chance = np.random.default_rng([seed, 1])
    robot = KinematicRobot(site.model.travel, DOCK, chance, KinematicSettings(energy=ENERGY))
    service = RequestService(site, planner=planner)
    return DayRun(service, robot, documents, MIDNIGHT).run(MIDNIGHT + DAY + 3600.0), robot


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
    options = parser.parse_args()
    places = dict(load_mission(ROOT / "map/mission.yaml").places)
    model = PlanningModel(GridTravelTimes(load_map(HOME_MAP)), ENERGY, DOCK)
    site = Site(places, model, Knowledge(tuple(places), True))
    kept, due, empty, better, worse = {"plan": 0, "baseline": 0}, 0, {"plan": 0, "baseline": 0}, 0, 0
    lowest = {"plan": 1.0, "baseline": 1.0}
    for seed in range(options.first_seed, options.first_seed + options.days):
        records = {}
        for name, planner in (("plan", None), ("baseline", FirstComeFirstServed())):
            record, robot = run_day(site, seed, options.requests, planner)
            records[name] = record
            kept[name] += len(record.kept)
            empty[name] += robot.empty_at is not None
            lowest[name] = min(lowest[name], record.lowest_charge)
        due += len(records["plan"].with_deadline)
        difference = len(records["plan"].kept) - len(records["baseline"].kept)
        better, worse = better + (difference > 0), worse + (difference < 0)
    for name in kept:
        print(
            f"{name}: {kept[name]} of {due} deadlines kept, {empty[name]} days with an empty battery, "
            f"lowest charge {100.0 * lowest[name]:.0f} %"
        )
    print(f"days better {better}, worse {worse}, sign test p = {sign_test(better, worse):.3g}")
    return 1 if empty["plan"] else 0


if __name__ == "__main__":
    sys.exit(main())
