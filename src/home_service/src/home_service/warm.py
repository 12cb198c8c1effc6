"""Compiles what the mission needs ahead of time, so that no node stalls when it is needed first."""

from home_service.cli import read_inputs
from home_service.options import parse
from home_service.rehearse import rehearse

if __name__ == "__main__":
    options = parse(["rehearse"])
    read_inputs(options)
    raise SystemExit(rehearse(options))
