import numpy as np
import pytest

from planar import grid_from_picture
from run_report import (
    CollisionEvent,
    GoalEvent,
    LoggedWarning,
    MarkerEvent,
    RunRecord,
    StateEvent,
    ZoneRecord,
)


@pytest.fixture
def record():
    """A robot that drives 4 m to the east in 8 s, 2 cm north of its estimate."""
    stamps = np.linspace(0.0, 8.0, 81)
    zero = np.zeros_like(stamps)
    truth = np.column_stack([stamps, 1.0 + 0.5 * stamps, 2.0 + zero, zero])
    estimate = truth + [0.0, 0.0, -0.02, 0.1]
    return RunRecord(
        truth=truth,
        estimate=estimate[::2],
        odometry=truth,
        velocity=np.column_stack([stamps, 0.5 + zero, zero]),
        pace=np.column_stack([stamps, stamps / 4.0]),
        plans=[truth[:, 1:3]],
        states=[StateEvent(0.0, "going to pickup"), StateEvent(6.0, "picking up <now>")],
        goals=[GoalEvent(0.1, 5.0, 2.0, 0.0)],
        markings=[
            MarkerEvent(0.0, "parcel 0", True, 5.0, 2.0),
            MarkerEvent(6.0, "parcel 0", False, 5.0, 2.0),
        ],
        collisions=[CollisionEvent(3.0, "sofa")],
        warnings=[LoggedWarning(1.0, "amcl", "no <scan> & no map")],
        zones=[ZoneRecord("pickup", 5.0, 2.0, 0.0, 0.35)],
        grid=grid_from_picture("########\n#......#\n#...?..#\n########"),
    )


@pytest.fixture
def result():
    return {
        "command": "home_service",
        "success": True,
        "reason": "picked up & delivered",
        "seed": 7,
        "simulated_seconds": 8.0,
        "position_error": {"pickup": 0.0123},
        "collisions": ["sofa"],
        "localization_error": {"mean": 0.02, "rmse": 0.02, "max": 0.02},
        "versions": {"python": "3.11"},
    }
