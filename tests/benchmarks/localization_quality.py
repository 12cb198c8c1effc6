#!/usr/bin/env python3
"""How far amcl_lite's localization_quality can be trusted: judged at right and at wrong poses.

Right poses are the truth, off by a few centimetres; wrong ones lie anywhere, or near, or where scan matching
draws a wrong pose to. Some scans are cut short by obstacles that are not on the map. The quality's
coefficients were fitted in map/home.world; hallway, office and these drives were not used for it.

    tests/benchmarks/localization_quality.py [--seconds 60]
"""

import argparse
from dataclasses import replace
from typing import List, Tuple

import numpy as np
from helpers.drives import Observation, random_drive
from helpers.localization_cases import Place, places
from scipy.stats import rankdata

from amcl_lite.config import LocalizerSettings
from amcl_lite.filter.particles import FreeSpace
from amcl_lite.recovery.quality import scan_quality
from amcl_lite.sensor.beams import all_beams, evenly_spaced_beams
from amcl_lite.sensor.likelihood_field import likelihood_field
from amcl_lite.sensor.scan_matching import match_scan
from planar import Pose2, Scan

SETTINGS = LocalizerSettings(beams=60)
SEED, EVERY = 500, 20
CUT_SHORT = (0.0, 0.2, 0.4)
RIGHT_WITHIN = 0.5
LIMITS = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=60.0, help="length of each drive (%(default)s)")
    arguments = parser.parse_args()
    print("world     poses  right  area under ROC  right and above 0.5  wrong and above 0.5")
    everything = []
    for number, place in enumerate(places()):
        drive = random_drive(place.world, place.grid, SEED + number, arguments.seconds, start=place.start)
        judged = np.array(_judged(place, drive[::EVERY], np.random.default_rng(SEED + number)))
        everything.append(judged)
        print(f"{place.name:8}", _row(judged))
    judged = np.concatenate(everything)
    print(f"{'all':8}", _row(judged))
    print("quality      poses  of these right")
    for low, high in zip(LIMITS, LIMITS[1:]):
        chosen = judged[(judged[:, 0] >= low) & (judged[:, 0] <= high), 1]
        print(
            f"{low:.1f} to {high:.1f}  {len(chosen):6}  {chosen.mean() if len(chosen) else float('nan'):.2f}"
        )


def _judged(place: Place, observations: List[Observation], rng) -> List[Tuple[float, bool]]:
    """The quality of poses, and whether they are right."""
    field = likelihood_field(place.grid, SETTINGS.sigma_hit, SETTINGS.likelihood_max_distance)
    free_space, rows = FreeSpace(place.grid), []
    for observation in observations:
        truth = observation.base_in_map
        for share in CUT_SHORT:
            scan = _cut_short(observation.scan, share, rng)
            beams, ends_xy = evenly_spaced_beams(scan, SETTINGS), all_beams(scan, SETTINGS).ends_xy
            anywhere = Pose2.from_array(free_space.draw(1, rng)[0])
            direction = rng.uniform(-np.pi, np.pi)
            beside = Pose2(np.cos(direction), np.sin(direction), rng.normal(0.0, 0.2))
            poses = (
                truth @ Pose2.from_array(rng.normal(0.0, (0.04, 0.04, 0.015))),
                anywhere,
                match_scan(anywhere, 0.1 * np.eye(3), ends_xy, field),
                truth @ beside,
            )
            for pose in poses:
                quality = scan_quality(pose, beams, field, place.grid).probability
                rows.append((quality, pose.distance_to(truth) < RIGHT_WITHIN))
    return rows


def _cut_short(scan: Scan, share: float, rng) -> Scan:
    """A scan of which ``share`` of the beams, in bunches, end at obstacles that are not on the map."""
    ranges, cut = scan.ranges.copy(), 0
    while cut < share * len(ranges):
        bunch = (rng.integers(len(ranges)) + np.arange(rng.integers(5, 40))) % len(ranges)
        ranges[bunch] = np.minimum(ranges[bunch], rng.uniform(0.4, 3.0))
        cut += len(bunch)
    return replace(scan, ranges=ranges)


def _row(judged: np.ndarray) -> str:
    quality, is_right = judged[:, 0], judged[:, 1] > 0.0
    right, wrong = int(is_right.sum()), int((~is_right).sum())
    ranks = rankdata(quality)[is_right].sum() - right * (right + 1) / 2
    above = [(quality[chosen] > 0.5).mean() for chosen in (is_right, ~is_right)]
    area = ranks / (right * wrong)
    return f"{len(judged):6} {right:6}  {area:14.4f}  {above[0]:19.3f}  {above[1]:19.3f}"


if __name__ == "__main__":
    main()
