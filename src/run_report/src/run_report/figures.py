"""Figures of a run, computed from its record."""

from typing import Any, Dict

import numpy as np

from planar import wrap
from run_report.record import RunRecord

MATCH_SECONDS = 0.01


def localization_errors(record: RunRecord) -> np.ndarray:
    """Return errors of the estimate where there is a true pose of the same stamp.

    Returns:
        (N, 3), stamp, position error [m], heading error [rad].
    """
    if not len(record.truth) or not len(record.estimate):
        return np.zeros((0, 3))
    later = np.searchsorted(record.truth[:, 0], record.estimate[:, 0] - MATCH_SECONDS)
    later = np.minimum(later, len(record.truth) - 1)
    true = record.truth[later]
    matches = np.abs(true[:, 0] - record.estimate[:, 0]) <= MATCH_SECONDS
    true, estimate = true[matches], record.estimate[matches]
    distance = np.hypot(*(estimate[:, 1:3] - true[:, 1:3]).T)
    return np.column_stack([estimate[:, 0], distance, np.abs(wrap(estimate[:, 3] - true[:, 3]))])


def real_time_factors(record: RunRecord, window: float = 1.0) -> np.ndarray:
    """Return (N, 2): stamp and simulated per wall-clock time over the last ``window`` wall-clock seconds."""
    if len(record.pace) < 2:
        return np.zeros((0, 2))
    simulated, wall = record.pace.T
    before = np.interp(wall - window, wall, simulated)
    return np.column_stack(
        [simulated, (simulated - before) / np.minimum(window, np.maximum(wall - wall[0], 0.05))]
    )[1:]


def summary(record: RunRecord) -> Dict[str, Any]:
    """Return the fields of result.json that are computed from a record."""
    errors = localization_errors(record)[:, 1]
    figures: Dict[str, Any] = {"warnings": len(record.warnings)}
    if len(errors):
        figures["localization_error"] = {
            "mean": round(float(errors.mean()), 4),
            "rmse": round(float(np.sqrt((errors**2).mean())), 4),
            "max": round(float(errors.max()), 4),
        }
    if len(record.velocity):
        figures["max_speed"] = round(float(np.abs(record.velocity[:, 1]).max()), 3)
    return figures
