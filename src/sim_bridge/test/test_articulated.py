"""Models with joints."""

import math

import numpy as np
import pytest

from sim_bridge import Scene, SimulationSettings
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.physics.forces import JointEffort
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.sdf import read_model

BOX = "<geometry><box><size>0.2 0.2 0.2</size></box></geometry>"
PENDULUM_LENGTH = 0.5


def link(name, pose="0 0 0 0 0 0", mass=1.0, size="0.2 0.2 0.2"):
    return (
        f"<link name='{name}'><pose>{pose}</pose><inertial><mass>{mass}</mass></inertial>"
        f"<collision name='c'><geometry><box><size>{size}</size></box></geometry></collision></link>"
    )


def joint(kind, parent, child, content="", name="hinge", axis="0 1 0", limits=""):
    return (
        f"<joint name='{name}' type='{kind}'><parent>{parent}</parent><child>{child}</child>{content}"
        f"<axis><xyz>{axis}</xyz><limit>{limits}</limit></axis></joint>"
    )


def scene_of(*content, pose=None, version="1.6"):
    text = f"<sdf version='{version}'><model name='any'>{''.join(content)}</model></sdf>"
    world = read_model(text, "m", np.eye(4) if pose is None else pose)
    return Scene(world, SimulationSettings(physics_rate=1000, odometry_rate=50, scan_rate=10)), world


def run(scene, seconds):
    for _ in range(round(seconds / scene.step_seconds)):
        scene.step()


def test_a_pendulum_swings_with_its_period():
    scene, _ = scene_of(
        link("bob", f"{PENDULUM_LENGTH} 0 3 0 0 0", size="0.01 0.01 0.01"),
        joint("revolute", "world", "bob", f"<pose>{-PENDULUM_LENGTH} 0 0 0 0 0</pose>"),
    )
    scene.joints.set_positions({"m::hinge": math.pi / 2.0 - 0.05})
    passes, before = [], -1.0
    for _ in range(300):
        scene.step()
        angle = scene.joints.state("m::hinge").position - math.pi / 2.0
        if (angle > 0.0) != (before > 0.0):
            passes.append(scene.stamp)
        before = angle
    period = 2.0 * (passes[-1] - passes[0]) / (len(passes) - 1)
    assert period == pytest.approx(2.0 * math.pi * math.sqrt(PENDULUM_LENGTH / 9.8), rel=0.02)


def test_links_start_where_they_are_placed_whatever_the_joint_frame():
    scene, world = scene_of(
        link("a", "0 0 1 0.3 0 0"),
        link("b", "0.4 0.1 1.2 0 0.2 0.5"),
        link("c", "0.8 0.1 1.4 0 0 1"),
        joint("revolute", "a", "b", "<pose>0.1 0.2 0 0.4 0 0</pose>", name="one"),
        joint("prismatic", "b", "c", "<pose>0 -0.1 0 0 0.7 0</pose>", name="two"),
        pose=pose3(1.0, 2.0, 0.0, yaw=0.7),
    )
    for body in world.bodies:
        assert scene.models.link_state(body.name).pose == pytest.approx(body.pose_in_world, abs=1e-5)


def test_joint_limits_stop_a_door():
    scene, _ = scene_of(
        link("door", "0.5 0 1 0 0 0", size="1 0.05 2"),
        joint(
            "revolute",
            "world",
            "door",
            "<pose>-0.5 0 0 0 0 0</pose>",
            axis="0 0 1",
            limits="<lower>0</lower><upper>1</upper>",
        ),
    )
    door = scene.models.links_of("m")[0]
    before = scene.models.link_state(door).pose
    scene.forces.apply_joint_effort(JointEffort("m::hinge", 5.0, 0.0, np.inf))
    run(scene, 5.0)
    assert scene.joints.state("m::hinge").position == pytest.approx(1.0, abs=0.02)
    assert before[2, 3] == pytest.approx(
        scene.models.link_state(door).pose[2, 3], abs=1e-3
    ), "it hangs, not falls"


@pytest.mark.parametrize(("limit", "effort"), [("upper", 5.0), ("lower", -5.0)])
def test_a_single_limit_stops_a_door(limit, effort):
    bound = 0.6 if limit == "upper" else -0.6
    door = link("door", "0.5 0 1 0 0 0", size="1 0.05 2")
    hinge = "<pose>-0.5 0 0 0 0 0</pose>"
    limits = f"<{limit}>{bound}</{limit}>"
    scene, _ = scene_of(door, joint("revolute", "world", "door", hinge, axis="0 0 1", limits=limits))
    scene.forces.apply_joint_effort(JointEffort("m::hinge", effort, 0.0, np.inf))
    run(scene, 3.0)
    assert scene.joints.state("m::hinge").position == pytest.approx(bound, abs=0.02)
    scene.forces.clear()
    scene.forces.apply_joint_effort(JointEffort("m::hinge", -effort, 0.0, np.inf))
    run(scene, 3.0)
    assert abs(scene.joints.state("m::hinge").position) > 3.0, "the other side is free"


def test_a_drawer_slides_along_its_axis():
    scene, _ = scene_of(
        link("drawer", "0 0 1 0 0 0"),
        joint("prismatic", "world", "drawer", axis="1 0 0", limits="<lower>0</lower><upper>0.3</upper>"),
    )
    scene.joints.set_positions({"m::hinge": 0.2})
    assert scene.models.link_state("m::drawer").pose[:3, 3] == pytest.approx([0.2, 0.0, 1.0], abs=1e-6)


@pytest.mark.parametrize("bounds", [("-1.79769e+308", "1.79769e+308"), ("-inf", "inf"), ("-1e+16", "1e+16")])
def test_numbers_that_gazebo_writes_for_no_limit_are_infinite(bounds):
    lower, upper = bounds
    limits = f"<lower>{lower}</lower><upper>{upper}</upper><effort>1.79769e+308</effort>"
    _, world = scene_of(link("wheel"), joint("revolute", "world", "wheel", limits=limits))
    assert (world.joints[0].lower, world.joints[0].upper, world.joints[0].effort) == (-np.inf, np.inf, np.inf)


def test_links_with_a_fixed_joint_fall_together():
    scene, _ = scene_of(link("a", "0 0 9 0 0 0"), link("b", "1 0 9 0 0 0", 5.0), joint("fixed", "a", "b"))
    run(scene, 1.0)
    a, b = (scene.models.link_state(f"m::{name}").pose[:3, 3] for name in "ab")
    assert a[2] == pytest.approx(9.0 - 4.9, abs=0.05)
    assert b - a == pytest.approx([1.0, 0.0, 0.0], abs=1e-3)


@pytest.mark.parametrize("content", ["<gravity>0</gravity>", "<kinematic>1</kinematic>"])
def test_a_link_without_gravity_does_not_fall(content):
    weightless = link("a", "0 0 2 0 0 0").replace("<inertial>", content + "<inertial>")
    scene, _ = scene_of(weightless)
    run(scene, 1.0)
    assert scene.models.link_state("m::a").pose[2, 3] == pytest.approx(2.0, abs=1e-3)


def test_the_pose_of_a_whole_model_can_be_set():
    scene, _ = scene_of(link("a", "0 0 1 0 0 0"), link("b", "1 0 1 0 0 0"), joint("revolute", "a", "b"))
    scene.set_model_state("m", KinematicState(pose3(5.0, 0.0, 1.0), np.zeros(3), np.zeros(3)))
    assert scene.models.link_state("m::b").pose[:3, 3] == pytest.approx([6.0, 0.0, 2.0], abs=1e-6)
    scene.reset_poses()
    assert scene.models.link_state("m::b").pose[:3, 3] == pytest.approx([1.0, 0.0, 1.0], abs=1e-6)


def test_axes_before_sdf_1_5_are_those_of_the_model():
    turned = link("a", "0 0 1 0 0 1.5707963")
    _, old = scene_of(turned, joint("prismatic", "world", "a", axis="1 0 0"), version="1.4")
    _, new = scene_of(turned, joint("prismatic", "world", "a", axis="1 0 0"), version="1.6")
    assert old.joints[0].axis == pytest.approx([0.0, -1.0, 0.0], abs=1e-6)
    assert new.joints[0].axis == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)


def test_unsupported_joints_give_a_warning():
    a, b = link("a"), link("b", "0 0 1 0 0 0")
    _, held = scene_of(a, b, joint("ball", "a", "b"))
    assert held.joints[0].kind == "fixed"
    assert "joint 'hinge': joint type 'ball' is not supported" in held.warnings[0]
    _, looped = scene_of(a, b, joint("fixed", "a", "b", name="one"), joint("fixed", "b", "a", name="two"))
    assert [joint.name for joint in looped.joints] == ["m::one"]
    assert "joint 'two': closes a loop" in looped.warnings[0]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (joint("revolute", "a", "nobody"), "child: there is no link 'nobody'"),
        (joint("revolute", "a", "world"), "the child must be a link"),
        (joint("revolute", "world", "a", axis="0 0 0"), "an axis needs a direction"),
        (
            joint("revolute", "world", "a", limits="<lower>1</lower><upper>0</upper>"),
            "the lower limit 1 is above the upper one 0",
        ),
        ("<joint name='hinge' type='fixed'/>", "joint 'hinge': <parent> is missing"),
    ],
)
def test_errors_about_joints_name_them(text, reason):
    with pytest.raises(WorldError, match="hinge") as caught:
        scene_of(link("a"), text)
    assert reason in str(caught.value)
