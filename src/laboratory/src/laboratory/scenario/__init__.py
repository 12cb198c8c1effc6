"""Scenarios: what is played, as data."""

from laboratory.scenario.reading import read_scenario
from laboratory.scenario.scenario import Scenario

__all__ = ["Scenario", "read_scenario"]
