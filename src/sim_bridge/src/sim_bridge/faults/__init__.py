"""Faults as data: what goes wrong with a robot's sensors, its drive and its home, when and how much."""

from sim_bridge.faults.faulty import Faults
from sim_bridge.faults.file import load_faults
from sim_bridge.faults.kind import Fault, Stage
from sim_bridge.faults.registry import KINDS, kind_named, usual_strength, why_not_of_strength

__all__ = [
    "KINDS",
    "Fault",
    "Faults",
    "Stage",
    "kind_named",
    "load_faults",
    "usual_strength",
    "why_not_of_strength",
]
