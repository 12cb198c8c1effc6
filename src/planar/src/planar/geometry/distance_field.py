"""Distances to the nearest obstacle, the base of likelihood fields and inflation."""

import numpy as np
from scipy.ndimage import distance_transform_edt


def distance_field(obstacles: np.ndarray, resolution: float, max_distance: float = np.inf) -> np.ndarray:
    """Euclidean distance, metres, from each cell centre to the nearest obstacle cell's centre.

    ``obstacles``: bool (rows, cols). Returns float32 (rows, cols), clipped to ``max_distance``;
    all ``max_distance`` where there is no obstacle at all.
    """
    if not obstacles.any():
        return np.full(obstacles.shape, max_distance, dtype=np.float32)
    distances = distance_transform_edt(~obstacles, sampling=resolution)
    return np.minimum(distances, max_distance).astype(np.float32)
