"""Figures of result.json that are computed from run events."""

from typing import Callable, Tuple

from evaluation.consumers.first_motion import FirstMotion
from evaluation.contracts import Figure

# Each is created for every run; its fields are described in config/result.schema.json.
FIGURES: Tuple[Callable[[], Figure], ...] = (FirstMotion,)
