"""Scenarios: world, robot, task and disturbances of a run, as data."""

from laboratory.scenario.reader import read_scenario
from laboratory.scenario.scenario import OFFICIAL, Scenario

__all__ = ["OFFICIAL", "Scenario", "read_scenario"]
