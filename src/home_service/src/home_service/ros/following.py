"""Runs of an errand that another robot follows."""

from typing import Mapping

from evaluation.consumers.referee import Referee
from evaluation.consumers.run_recorder import RunRecorder
from evaluation.options import LaunchPlan, RunOptions
from evaluation.ros.run import Run
from evaluation.verdict import ERRAND, Verdict
from home_service.follow_monitor import FollowMonitor
from planar.maps.places import NamedPlace
from supervision.display import Display


def run_follow(options: RunOptions, launch: LaunchPlan, places: Mapping[str, NamedPlace]) -> int:
    """Run an errand that another robot follows; return the exit code."""
    display = Display()
    referee = Referee(places, display.print)
    following = FollowMonitor("follower")
    with Run(options, launch, referee, RunRecorder(places), display, [following]) as run:
        failure = run.watch(lambda: referee.has_seen({ERRAND}))
        verdict = referee.verdict({ERRAND}, failure)
        if verdict.success:
            failure = following.failure
            verdict = Verdict(failure is None, failure or f"{verdict.reason}; {following.description}")
        return run.conclude(verdict, **following.result_fields())
