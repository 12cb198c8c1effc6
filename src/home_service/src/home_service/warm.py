"""Compiles the kernels of every node ahead of time, so that none stalls when it is needed first."""

import explorer_lite.warming
import slam_lite.warming
from home_service.commands.rehearse import Rehearse
from home_service.nursery import load_kernels


def main() -> int:
    """Does what each node does when it starts, then plays the mission."""
    load_kernels()
    explorer_lite.warming.warm_up()
    slam_lite.warming.warm_up()
    return Rehearse().run()


if __name__ == "__main__":
    raise SystemExit(main())
