import pytest

from planar import Twist2
from teleop_lite.key_script import KeyScriptError, parse
from teleop_lite.turtlebot3 import KEYS, SteppedTeleop


def after(keys, ticks, model="burger"):
    teleop = SteppedTeleop(model)
    for key in keys:
        teleop.press(key)
    for tick in range(ticks):
        command = teleop.tick(tick * 0.1)
    return command


def test_each_key_changes_the_velocity_by_a_step_that_is_kept():
    command = after("wwwad", 100)
    assert command.v == pytest.approx(0.03)
    assert command.omega == pytest.approx(0.0)


def test_the_velocity_rises_by_half_a_step_a_tick():
    assert after("ww", 1).v == pytest.approx(0.005)


@pytest.mark.parametrize(("model", "v"), [("burger", 0.22), ("waffle", 0.26), ("unheard_of", 0.22)])
def test_a_model_does_not_exceed_its_maximum(model, v):
    assert after("w" * 50, 200, model).v == pytest.approx(v)
    assert after("x" * 50, 200, model).v == pytest.approx(-v)


@pytest.mark.parametrize("key", "s ")
def test_a_stop_key_stops_at_once(key):
    assert after("wwww" + "a" + key, 1) == Twist2()


def test_a_script_may_only_use_the_keys_of_its_robot():
    assert [stroke.key for stroke in parse("w:1.0 a d s", KEYS)] == ["w", "a", "d", "s"]
    with pytest.raises(KeyScriptError):
        parse("i:1.0", KEYS)
