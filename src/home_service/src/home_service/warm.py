"""Compile the kernels of all nodes ahead of time, so that no node has to compile when it starts."""

import slam_lite.warming
from evaluation.preload import load_kernels
from explorer_lite.explorer import warm_up as warm_up_explorer
from headless_mission import NAVIGATION_CONFIG, EpisodeConditions
from home_service.commands.rehearse import Rehearse
from move_base_lite.control import LOCAL_PLANNERS
from move_base_lite.warmup import warm_up as warm_up_navigator


def main() -> int:
    """Warm up each node's kernels, then run the headless mission; return its exit code."""
    load_kernels()
    warm_up_local_planners()
    warm_up_explorer()
    slam_lite.warming.warm_up()
    return Rehearse().run()


def warm_up_local_planners() -> None:
    """Compile the kernels of every local planner."""
    for name in LOCAL_PLANNERS.names:
        warm_up_navigator(EpisodeConditions(name).navigation(NAVIGATION_CONFIG))


if __name__ == "__main__":
    raise SystemExit(main())
