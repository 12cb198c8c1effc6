"""Infrared field of a Kobuki's dock, and what the receivers of a robot sense of it (kobuki_dock_drive).

A dock sends three fans from its front: left, centre and right as the dock sees it, so that the left fan is on
the right of a robot that faces the dock. Within a shorter distance, the near signal is received as well. The
pose of a dock is that of its front on the floor, with the x axis away from the dock.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Iterator, Tuple

from planar.config.parameters import POSITIVE, Interval, check_parameters, parameter
from planar.geometry.pose import Pose2, wrap

# Bits of a receiver's byte (kobuki_msgs/DockInfraRed).
NEAR_LEFT, NEAR_CENTRE, NEAR_RIGHT = 1, 2, 4
FAR_CENTRE, FAR_LEFT, FAR_RIGHT = 8, 16, 32
NEAR, FAR = NEAR_LEFT | NEAR_CENTRE | NEAR_RIGHT, FAR_LEFT | FAR_CENTRE | FAR_RIGHT
LEFT, CENTRE, RIGHT = NEAR_LEFT | FAR_LEFT, NEAR_CENTRE | FAR_CENTRE, NEAR_RIGHT | FAR_RIGHT
# Distance from the base's origin to the front of a Kobuki, where its contacts are [m].
ROBOT_FRONT = 0.178
_ANGLE = Interval(0.0, math.pi, "an angle up to pi", exclusive_low=True)


@dataclass(frozen=True)
class DockField:
    """Geometry of a dock's field, of the robot's receivers, and of the charging contact."""

    dock_centre_half_angle: float = parameter(
        0.0524, "half of the opening angle of the dock's centre fan", "rad", _ANGLE
    )
    dock_side_half_angle: float = parameter(
        1.05, "largest angle between the dock's middle line and a signal", "rad", _ANGLE
    )
    dock_near_range: float = parameter(0.6, "range of the dock's near signals", "m", POSITIVE)
    dock_far_range: float = parameter(2.5, "range of the dock's far signals", "m", POSITIVE)
    dock_receiver_bearing: float = parameter(
        1.31, "bearing of the left receiver; the right one mirrors it", "rad", _ANGLE
    )
    dock_receiver_half_angle: float = parameter(
        0.785, "half of the opening angle of a receiver", "rad", _ANGLE
    )
    dock_receiver_radius: float = parameter(
        0.17, "distance of the receivers from the base's origin", "m", POSITIVE
    )
    dock_contact_distance: float = parameter(
        0.03, "distance of the robot's front to the dock within which it charges", "m", POSITIVE
    )
    dock_contact_angle: float = parameter(
        0.175, "angle between robot and dock within which it charges", "rad", _ANGLE
    )

    def __post_init__(self):
        check_parameters(self)

    def receivers(self, base: Pose2) -> Iterator[Pose2]:
        """Yield the right, centre and left receiver, the x axis along the middle of what each sees.

        Args:
            base: Pose of the robot, in the frame in which those of the receivers are wanted.
        """
        for receiver_in_base in self._receivers_in_base:
            yield base @ receiver_in_base

    @cached_property
    def _receivers_in_base(self) -> Tuple[Pose2, ...]:
        bearings = (-self.dock_receiver_bearing, 0.0, self.dock_receiver_bearing)
        return tuple(Pose2(0.0, 0.0, bearing) @ Pose2(self.dock_receiver_radius) for bearing in bearings)

    def signal(self, receiver_in_dock: Pose2) -> int:
        """Return the bits of what a receiver senses if nothing is in between."""
        x, y = receiver_in_dock.x, receiver_in_dock.y
        distance, angle = math.hypot(x, y), math.atan2(y, x)
        if distance > self.dock_far_range or abs(angle) > self.dock_side_half_angle:
            return 0
        if abs(wrap(math.atan2(-y, -x) - receiver_in_dock.yaw)) > self.dock_receiver_half_angle:
            return 0
        fan = CENTRE if abs(angle) <= self.dock_centre_half_angle else LEFT if angle > 0.0 else RIGHT
        return fan if distance <= self.dock_near_range else fan & FAR

    def signals(self, base_in_dock: Pose2) -> Tuple[int, int, int]:
        """Return the bytes of the right, centre and left receiver if nothing is in between."""
        right, centre, left = map(self.signal, self.receivers(base_in_dock))
        return right, centre, left

    def has_contact(self, base_in_dock: Pose2) -> bool:
        """Return whether a robot touches the charging contacts."""
        front = base_in_dock @ Pose2(ROBOT_FRONT)
        return (
            abs(front.x) <= self.dock_contact_distance
            and abs(front.y) <= self.dock_contact_distance
            and abs(wrap(front.yaw - math.pi)) <= self.dock_contact_angle
        )
