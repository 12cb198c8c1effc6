"""The infrared field of a dock, as a Kobuki's receivers sense it."""

import math

import pytest

from planar import Pose2
from planar.geometry.dock_field import CENTRE, FAR, LEFT, NEAR, RIGHT, ROBOT_FRONT, DockField

FIELD = DockField()


def facing(x: float, y: float) -> Pose2:
    """Return a robot that faces the dock, in the dock's frame."""
    return Pose2(x, y, math.atan2(-y, -x))


def test_a_robot_on_the_middle_line_senses_the_centre_fan_ahead():
    right, centre, left = FIELD.signals(facing(1.5, 0.0))
    assert (right, centre, left) == (0, CENTRE & FAR, 0)


@pytest.mark.parametrize("y, fan", [(0.8, LEFT), (-0.8, RIGHT)])
def test_left_and_right_are_the_docks_own(y, fan):
    assert FIELD.signals(facing(1.5, y))[1] == fan & FAR


def test_near_signals_come_with_the_far_ones():
    assert FIELD.signals(facing(0.5, 0.0))[1] == CENTRE
    assert not FIELD.signals(facing(1.0, 0.0))[1] & NEAR


def test_a_receiver_senses_the_dock_on_its_side_only():
    for yaw, sensing in ((math.pi / 2.0, 2), (-math.pi / 2.0, 0)):
        signals = FIELD.signals(Pose2(1.5, 0.0, yaw))
        assert [bool(signal) for signal in signals] == [number == sensing for number in range(3)]


@pytest.mark.parametrize("base", [Pose2(3.0, 0.0, math.pi), Pose2(0.5, 1.5, -1.9), Pose2(-1.0, 0.0, 0.0)])
def test_there_is_no_signal_out_of_range_beside_and_behind_the_dock(base):
    assert FIELD.signals(base) == (0, 0, 0)


@pytest.mark.parametrize(
    "gap, y, error, has_contact",
    [
        (0.02, 0.0, 0.0, True),
        (0.04, 0.0, 0.0, False),
        (0.02, 0.04, 0.0, False),
        (0.02, 0.0, 0.16, True),
        (0.02, 0.0, 0.2, False),
        (0.02, 0.0, math.pi, False),
    ],
)
def test_contacts_need_position_and_heading(gap, y, error, has_contact):
    front = Pose2(gap, y, math.pi + error)
    assert FIELD.has_contact(front @ Pose2(-ROBOT_FRONT)) is has_contact
