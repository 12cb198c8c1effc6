"""Check of the results of user-defined sensor and motion models."""

import math
from typing import Any, Tuple

import numpy as np

from planar.extensions import InvalidAnswer


def finite_numbers(result: Any, shape: Tuple[int, ...], most: float = math.inf) -> np.ndarray:
    """Return a result as an array of the expected shape.

    Args:
        result: What a model returned.
        shape: Expected shape.
        most: Largest absolute value.

    Raises:
        InvalidAnswer: It has another shape or invalid numbers.
    """
    numbers = np.array(result, dtype=float)
    if numbers.shape != shape or not (np.isfinite(numbers) & (np.abs(numbers) <= most)).all():
        up_to = f" up to {most:g}" if most < math.inf else ""
        raise InvalidAnswer(f"returned no {' by '.join(map(str, shape))} finite numbers{up_to}")
    return numbers
