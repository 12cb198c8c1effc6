"""Fault injection: faults of a robot's sensors, drive and environment, described as data."""

from planar.deprecation import deprecated_names
from sim_bridge.faults.file import load_faults
from sim_bridge.faults.injection import FaultInjector
from sim_bridge.faults.kind import Fault, FaultContext
from sim_bridge.faults.registry import KINDS, default_strength, kind_named, strength_error

__all__ = [
    "KINDS",
    "Fault",
    "FaultContext",
    "FaultInjector",
    "default_strength",
    "kind_named",
    "load_faults",
    "strength_error",
]

__getattr__ = deprecated_names(
    __name__,
    {
        "Faults": "FaultInjector",
        "Stage": "FaultContext",
        "usual_strength": "default_strength",
        "why_not_of_strength": "strength_error",
    },
)
