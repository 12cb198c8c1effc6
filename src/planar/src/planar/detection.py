"""Object detections, and the declared model of the detector: how likely an object in view is reported."""

from dataclasses import dataclass
from typing import Tuple

import numpy as np


@dataclass(frozen=True)
class Detection:
    """An object that the detector reports.

    Attributes:
        name: Name of the object.
        x: Position in the robot's base frame [m].
        y: Position in the robot's base frame [m].
        z: Height above the floor [m].
    """

    name: str
    x: float
    y: float
    z: float = 0.0


@dataclass(frozen=True)
class DetectionModel:
    """A forward-looking camera on a mast with a detector of objects that are named.

    Attributes:
        height: Height of the camera above the floor [m]; only what is higher hides objects.
        fov: Horizontal field of view [rad].
        range_min: Distance below which nothing is detected [m].
        range_full: Distance up to which detection is as likely as it gets [m].
        range_max: Distance from which on nothing is detected; the probability falls linearly to 0 [m].
        probability: Probability that one image of an object in view up to ``range_full`` leads to a
            detection.
        depth: Depth of shelves into which the camera sees [m].
        position_noise: Standard deviation of detected positions along each axis [m].
        rate: Images per second [Hz].
    """

    height: float = 1.2
    fov: float = 1.05
    range_min: float = 0.3
    range_full: float = 2.0
    range_max: float = 4.0
    probability: float = 0.9
    depth: float = 0.25
    position_noise: float = 0.03
    rate: float = 2.0

    def probability_at(self, ranges: np.ndarray, bearings: np.ndarray) -> np.ndarray:
        """Return the probability that an unhidden object is detected in one image.

        Args:
            ranges: Horizontal distances from the camera [m], any shape.
            bearings: Angles from its axis [rad], the same shape.
        """
        fade = np.clip((self.range_max - ranges) / (self.range_max - self.range_full), 0.0, 1.0)
        is_in_view = (np.abs(bearings) <= self.fov / 2.0) & (ranges >= self.range_min)
        return np.where(is_in_view, self.probability * fade, 0.0)


Detections = Tuple[Detection, ...]
