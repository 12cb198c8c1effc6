"""Friction and bounce between two surfaces, damping, and the largest speeds."""

import numpy as np
import pytest

from sim_bridge import Scene, SimulationSettings
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.sdf import read_model

GRAVITY = 9.8
BOX = "<box><size>0.4 0.4 0.1</size></box>"
PLANE = "<plane><normal>0 0 1</normal></plane>"


def model(name, geometry, surface="", pose=None, static=False, link=""):
    text = (
        f"<sdf version='1.6'><model name='any'><static>{int(static)}</static><link name='link'>{link}"
        f"<collision name='c'><geometry>{geometry}</geometry><surface>{surface}</surface></collision>"
        "</link></model></sdf>"
    )
    return read_model(text, name, np.eye(4) if pose is None else pose).bodies


def friction(mu, mu2=None):
    return f"<friction><ode><mu>{mu}</mu><mu2>{mu if mu2 is None else mu2}</mu2></ode></friction>"


def bounce(coefficient, threshold=""):
    return f"<bounce><restitution_coefficient>{coefficient}</restitution_coefficient>{threshold}</bounce>"


def scene_of(*models, rate=1000):
    scene = Scene(
        read_model("<sdf version='1.6'><model name='m'><static>1</static><link name='l'/></model></sdf>",
                   "nothing", np.eye(4)),
        SimulationSettings(physics_rate=rate, odometry_rate=50, scan_rate=10),
    )  # fmt: skip
    for bodies in models:
        scene.add(bodies)
    return scene


def run(scene, seconds):
    for _ in range(round(seconds / scene.step_seconds)):
        scene.step()


def push(scene, name, speed):
    pose = scene.models.state(name).pose
    scene.set_model_state(name, KinematicState(pose, np.array([speed, 0.0, 0.0]), np.zeros(3)))


def speed_of(scene, name):
    return scene.models.state(name).linear[0]


def deceleration(scene, name, speed=3.0, seconds=0.2):
    """Deceleration in g of a sliding model."""
    run(scene, 0.2)
    push(scene, name, speed)
    run(scene, 0.04)
    before = speed_of(scene, name)
    run(scene, seconds)
    return (before - speed_of(scene, name)) / seconds / GRAVITY


@pytest.mark.parametrize(
    ("floor", "box", "least"),
    [(0.5, 0.5, 0.5), (0.2, 0.5, 0.2), (0.5, 0.2, 0.2), (100, 0.4, 0.4), (0.0, 1.0, 0.0), (1, 1, 1)],
)
def test_the_smaller_friction_of_the_two_surfaces_acts(floor, box, least):
    scene = scene_of(
        model("floor", PLANE, friction(floor), static=True),
        model("box", BOX, friction(box), pose3(0.0, 0.0, 0.05)),
    )
    assert deceleration(scene, "box") == pytest.approx(least, rel=0.04, abs=0.003)


def test_a_stack_slides_by_the_friction_between_its_parts():
    """The lower box is held by 0.6 on 0.6; the upper one slides on it by 0.3 on 0.6."""
    scene = scene_of(
        model("floor", PLANE, friction(0.6), static=True),
        model("lower", "<box><size>3 1 0.1</size></box>", friction(0.6), pose3(0.0, 0.0, 0.05),
              link="<inertial><mass>50</mass></inertial>"),
        model("upper", BOX, friction(0.3), pose3(-1.0, 0.0, 0.15)),
    )  # fmt: skip
    assert deceleration(scene, "upper", 2.0) == pytest.approx(0.3, rel=0.05)
    assert abs(speed_of(scene, "lower")) < 1e-3


def test_two_floors_of_different_friction_each_act():
    scene = scene_of(
        model("ice", "<box><size>10 1 0.1</size></box>", friction(0.1), pose3(0, 0, -0.05), static=True),
        model("road", "<box><size>10 1 0.1</size></box>", friction(0.6), pose3(0, 3, -0.05), static=True),
        model("one", BOX, friction(0.4), pose3(-2.0, 0.0, 0.05)),
        model("other", BOX, friction(0.4), pose3(-2.0, 3.0, 0.05)),
    )
    run(scene, 0.2)
    assert deceleration(scene, "one") == pytest.approx(0.1, rel=0.05)
    assert deceleration(scene, "other") == pytest.approx(0.4, rel=0.05)


def test_a_model_that_is_added_later_changes_nothing_for_the_others():
    scene = scene_of(
        model("floor", PLANE, friction(0.5), static=True),
        model("box", BOX, friction(0.5), pose3(0.0, 0.0, 0.05)),
    )
    scene.step()
    scene.add(model("rail", BOX, friction(0.9), pose3(5.0, 5.0, 0.05), static=True))
    assert deceleration(scene, "box") == pytest.approx(0.5, rel=0.04)
    scene.remove_model("rail")
    assert deceleration(scene, "box") == pytest.approx(0.5, rel=0.04)


def test_friction_repeats_after_a_rewind():
    scene = scene_of(
        model("floor", PLANE, friction(0.5), static=True),
        model("wall", BOX, friction(0.2), pose3(0.6, 0.0, 0.05), static=True),
        model("box", BOX, friction(0.4), pose3(0.0, 0.0, 0.05)),
    )
    run(scene, 0.1)
    scene.mark()
    ends = []
    for _ in range(2):
        scene.rewind(0)
        push(scene, "box", 2.0)
        run(scene, 0.5)
        ends.append(scene.models.state("box").pose)
    assert np.array_equal(*ends)


def bounced(*surfaces):
    """Speed after the impact of a ball that falls 1 m, relative to that before."""
    floor, ball = surfaces
    scene = scene_of(
        model("floor", PLANE, floor, static=True),
        model("ball", "<sphere><radius>0.1</radius></sphere>", ball, pose3(0.0, 0.0, 1.1)),
        rate=200,
    )
    speeds = []
    for _ in range(40):
        scene.step()
        speeds.append(scene.models.state("ball").linear[2])
    impact = int(np.argmin(speeds))
    return max(speeds[impact:]) / np.sqrt(2.0 * GRAVITY)


@pytest.mark.parametrize(
    ("floor", "ball", "least"), [(0.8, 0.8, 0.8), (0.5, 0.9, 0.5), (0.9, 0.5, 0.5), (0.0, 0.8, 0.0)]
)
def test_the_smaller_restitution_of_the_two_surfaces_acts(floor, ball, least):
    assert bounced(bounce(floor), bounce(ball)) == pytest.approx(least, abs=0.05)


def test_an_impact_slower_than_the_threshold_does_not_bounce():
    fast, slow = ("<threshold>3</threshold>", "<threshold>6</threshold>")
    assert bounced(bounce(0.8, fast), bounce(0.8, fast)) == pytest.approx(0.8, abs=0.05)
    assert bounced(bounce(0.8, slow), bounce(0.8, slow)) < 0.05
    assert bounced(bounce(0.8, fast), bounce(0.8, slow)) == pytest.approx(0.8, abs=0.05)


def test_velocity_decay_is_the_share_of_the_velocity_lost_in_each_of_gazebos_steps():
    """ODE multiplies by 1 - decay in each step of 1 ms; so 0.002 leaves 0.998 ** 500 after half a second."""
    decay = "<velocity_decay><linear>0.002</linear><angular>0.004</angular></velocity_decay>"
    scene = scene_of(model("box", BOX, pose=pose3(0.0, 0.0, 5.0), link=decay + "<gravity>0</gravity>"))
    pose = scene.models.state("box").pose
    for speed in (0.5, 5.0):
        state = KinematicState(pose, np.array([speed, 0.0, 0.0]), np.array([0.0, 0.0, speed]))
        scene.set_model_state("box", state)
        run(scene, 0.5)
        after = scene.models.state("box")
        assert after.linear[0] == pytest.approx(speed * 0.998**500, rel=0.01)
        assert after.angular[2] == pytest.approx(speed * 0.996**500, rel=0.01)


def test_speeds_above_100_are_kept():
    scene = scene_of(model("box", BOX, pose=pose3(0.0, 0.0, 5.0), link="<gravity>0</gravity>"))
    state = KinematicState(pose3(0.0, 0.0, 5.0), np.array([250.0, 0.0, 0.0]), np.array([0.0, 0.0, 130.0]))
    scene.set_model_state("box", state)
    run(scene, 0.2)
    after = scene.models.state("box")
    assert after.linear[0] == pytest.approx(250.0, rel=1e-3)
    assert after.angular[2] == pytest.approx(130.0, rel=1e-3)
    assert after.pose[0, 3] == pytest.approx(50.0, rel=0.01)
