"""Positions of the world's points on the page."""

import math

import numpy as np

from cockpit.page.server import CAMERA, FIELD_OF_VIEW, LOOK_AT


def pixel(page, x, y):
    """Where a place of the floor is on the page, seen by the camera as it is at first."""
    forward = (LOOK_AT - CAMERA) / np.linalg.norm(LOOK_AT - CAMERA)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    seen = np.array((x, y, 0.0)) - CAMERA
    depth = seen @ forward
    left, top, width, height = page.evaluate(
        "(({x, y, width, height}) => [x, y, width, height])"
        "(document.querySelector('canvas').getBoundingClientRect())"
    )
    scale = height / 2.0 / math.tan(FIELD_OF_VIEW / 2.0) / depth
    across, up = seen @ right * scale, seen @ np.cross(right, forward) * scale
    return left + width / 2.0 + across, top + height / 2.0 - up
