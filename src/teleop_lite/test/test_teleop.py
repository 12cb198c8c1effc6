import pytest

from planar import SettingsError, Twist2
from teleop_lite import Teleop, TeleopSettings

TICK = 0.1


def velocities(teleop, ticks, held="", start=0.0):
    """The commands of a number of ticks while a key is held."""
    commands = []
    for i in range(ticks):
        for key in held:
            teleop.press(key)
        commands.append(teleop.tick(start + i * TICK))
    return commands


@pytest.mark.parametrize(
    "key, v, omega",
    [
        ("i", 0.2, 0.0),
        (",", -0.2, 0.0),
        ("j", 0.0, 1.0),
        ("l", 0.0, -1.0),
        ("u", 0.2, 1.0),
        ("o", 0.2, -1.0),
        ("m", -0.2, -1.0),
        (".", -0.2, 1.0),
    ],
)
def test_a_held_key_leads_to_the_velocity_of_turtlebot_teleop(key, v, omega):
    command = velocities(Teleop(), 10, key)[-1]
    assert (command.v, command.omega) == pytest.approx((v, omega))


def test_velocities_change_by_two_centimetres_and_a_tenth_of_a_radian_a_second_in_a_tick():
    first, second = velocities(Teleop(), 2, "u")
    assert (first.v, first.omega) == pytest.approx((0.02, 0.1))
    assert (second.v, second.omega) == pytest.approx((0.04, 0.2))


def test_a_key_repeated_within_a_tick_does_not_accelerate_the_ramp():
    assert velocities(Teleop(), 1, "iii")[0].v == pytest.approx(0.02)


def test_a_released_key_brings_the_robot_to_rest_after_half_a_second():
    teleop = Teleop()
    velocities(teleop, 10, "i")
    coasting = velocities(teleop, 20, start=1.0)
    assert [command.v for command in coasting[:4]] == pytest.approx([0.2] * 4)
    assert [command.v for command in coasting[4:7]] == pytest.approx([0.18, 0.16, 0.14])
    assert coasting[-1] == Twist2()


@pytest.mark.parametrize("key", ["k", " "])
def test_stop_keys_stop_at_once(key):
    teleop = Teleop()
    velocities(teleop, 10, "u")
    assert velocities(teleop, 1, key, start=1.0) == [Twist2()]


def test_any_other_key_stops_smoothly():
    teleop = Teleop()
    velocities(teleop, 10, "i")
    assert velocities(teleop, 2, "#", start=1.0)[-1].v == pytest.approx(0.16)


@pytest.mark.parametrize(
    "key, v, omega",
    [("q", 1.1, 1.1), ("z", 0.9, 0.9), ("w", 1.1, 1.0), ("x", 0.9, 1.0), ("e", 1.0, 1.1), ("c", 1.0, 0.9)],
)
def test_speed_keys_scale_the_full_speeds_and_do_not_stop_the_robot(key, v, omega):
    teleop = Teleop()
    velocities(teleop, 10, "i")
    teleop.press(key)
    assert (teleop.full.v, teleop.full.omega) == pytest.approx((0.2 * v, 1.0 * omega))
    assert teleop.tick(1.0).v == pytest.approx(min(0.2 * v, 0.22))


def test_the_initial_speeds_are_settings():
    teleop = Teleop(TeleopSettings(scale_linear=0.5, scale_angular=1.5))
    assert velocities(teleop, 30, "u")[-1] == Twist2(0.5, 1.5)


def test_an_invalid_speed_is_refused():
    with pytest.raises(SettingsError, match="scale_linear must be positive"):
        TeleopSettings(scale_linear=-1.0)
