"""Sources of velocity: the most important one that is not silent drives."""

import math

import pytest

from planar import SettingsError, Twist2
from sim_bridge.driving.mux import TURTLEBOT_INPUTS, VelocityMux, VelocitySmoother, read_inputs

STEP = 0.02
SLOW, FAST = Twist2(0.1, 0.0), Twist2(0.5, 0.0)


@pytest.fixture
def mux():
    return VelocityMux(TURTLEBOT_INPUTS)


def test_no_input_drives_when_all_are_silent(mux):
    assert mux.choose(0.0, {}) is None
    assert mux.active(0.0) == "idle"


def test_the_more_important_source_drives_until_it_falls_silent(mux):
    assert mux.choose(0.0, {"Navigation": FAST}) == FAST
    assert mux.choose(0.1, {"Navigation": FAST, "Teleoperation": SLOW}) == SLOW
    assert mux.choose(1.0, {"Navigation": FAST}) is None, "not while the other may still speak"
    assert mux.active(1.0) == "Teleoperation"
    assert mux.choose(1.11, {"Navigation": FAST}) == FAST
    assert mux.active(3.0) == "idle"


def test_a_reset_of_time_discards_old_commands(mux):
    mux.choose(100.0, {"Teleoperation": SLOW})
    assert mux.choose(0.0, {"Navigation": FAST}) == FAST


def test_inputs_are_read_from_a_file_of_the_official_format(tmp_path):
    path = tmp_path / "mux.yaml"
    path.write_text(
        "subscribers:\n"
        "  - {name: A, topic: input/a, timeout: 0.5, priority: 1, short_desc: first}\n"
        "  - {name: B, topic: input/b, timeout: 0.2, priority: 2}\n"
        "publisher: output/cmd_vel\n"
    )
    assert [(one.name, one.topic, one.timeout) for one in VelocityMux(read_inputs(path)).inputs] == [
        ("B", "input/b", 0.2),
        ("A", "input/a", 0.5),
    ]
    path.write_text("subscribers:\n  - {name: A, topic: a, timeout: soon, priority: 1}\n")
    with pytest.raises(SettingsError, match="mux.yaml:2: .*timeout"):
        read_inputs(path)


def commanded(smoother, seconds, begins):
    """Commands of the smoother at each step of so many seconds."""
    return [smoother.command(begins + step * STEP) for step in range(1, round(seconds / STEP) + 1)]


def test_a_smoothed_command_grows_by_its_acceleration_and_brakes_faster():
    smoother = VelocitySmoother()
    smoother.set_target(Twist2(0.5, 1.0), 0.0)
    smoother.command(0.0)
    assert commanded(smoother, 0.1, 0.0)[-1] == Twist2(pytest.approx(0.1), pytest.approx(0.2))
    smoother.set_target(Twist2(0.5, 1.0), 0.1)
    assert commanded(smoother, 0.4, 0.1)[-1] == Twist2(pytest.approx(0.5), pytest.approx(1.0))
    smoother.set_target(Twist2(), 0.5)
    assert commanded(smoother, 0.1, 0.5)[-1] == Twist2(pytest.approx(0.35), pytest.approx(0.7))
    for tenth in range(6, 20):
        smoother.set_target(Twist2(9.0, 0.0), 0.1 * tenth)
        fast = commanded(smoother, 0.1, 0.1 * tenth)[-1]
    assert fast.v == pytest.approx(0.8)


def test_after_a_pause_between_commands_no_velocity_jumps():
    smoother, commands = VelocitySmoother(), [Twist2()]
    for begins, pause in ((0.0, 0.1), (0.1, 0.44), (0.54, 0.1), (0.64, 0.7), (1.34, 0.3)):
        smoother.set_target(Twist2(0.0, 2.0), begins)
        commands += commanded(smoother, pause, begins)
    assert (
        max(after.omega - before.omega for before, after in zip(commands, commands[1:])) <= 2.0 * STEP + 1e-9
    )


def test_after_the_last_command_the_smoother_brakes_to_rest_and_then_publishes_nothing():
    smoother = VelocitySmoother()
    smoother.set_target(Twist2(0.3, 0.0), 0.0)
    commands = commanded(smoother, 2.0, 0.0)
    assert commands[-1] is None
    speeds = [one.v for one in commands if one is not None]
    assert max(speeds) == pytest.approx(0.3) and speeds[-1] == 0.0


def test_a_reset_of_time_resets_the_smoother():
    smoother = VelocitySmoother()
    smoother.set_target(Twist2(0.3, 0.0), 10.0)
    commanded(smoother, 0.4, 10.0)
    smoother.set_target(Twist2(0.3, 0.0), 0.0)
    assert smoother.command(0.0) == Twist2()
    assert smoother.command(STEP).v == pytest.approx(STEP)


def test_a_command_that_is_not_finite_is_passed_on_to_be_refused():
    smoother = VelocitySmoother()
    smoother.set_target(Twist2(math.nan, 0.0), 0.0)
    assert not smoother.command(STEP).is_finite()
    assert smoother.command(2.0 * STEP) is None
