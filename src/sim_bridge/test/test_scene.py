"""A scene: states of models are read and set, wrenches applied, poses reset; several robots share it."""

import math

import numpy as np
import pytest

from planar import Pose2, SettingsError, Twist2
from sim_bridge import ROBOTS, Scene, SimulationSettings, WorldError
from sim_bridge.errors import UnknownEntityError
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Box, Plane
from sim_bridge.physics.forces import LinkWrench
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.sdf import read_model
from sim_bridge.world import Body, Collision, World

LIDAR = ROBOTS["turtlebot_lidar"]
EXACT = SimulationSettings(
    range_noise=0.0, encoder_scale=0.0, wheel_slip=0.0, gyro_scale=0.0, gyro_bias=0.0, gyro_noise=0.0
)
BARBELL = """<sdf version='1.6'><model name='m'>
<link name='a'><pose>0 1 0 0 0 0</pose><collision name='c'><geometry><sphere><radius>0.2</radius></sphere>
</geometry></collision></link>
<link name='b'><pose>0 -1 0 0 0 0</pose><collision name='c'><geometry><sphere><radius>0.2</radius></sphere>
</geometry></collision></link></model></sdf>"""


def box(name, x, y=0.0, mass=None):
    return Body(f"{name}::link", pose3(x, y, 0.25), (Collision(Box((0.5, 0.5, 0.5)), np.eye(4)),), mass)


def at_rest(pose):
    return KinematicState(pose, np.zeros(3), np.zeros(3))


@pytest.fixture
def scene():
    floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
    return Scene(World("w", (floor, box("wall", 5.0), box("crate", 3.0, 2.0, mass=2.0))), EXACT)


def drive(scene, seconds, commands={}):
    """Give the commands at every step; return the last results."""
    for _ in range(round(seconds / scene.step_seconds)):
        results = scene.step(commands)
    return results


def test_a_models_pose_is_that_of_its_frame_not_of_its_first_link(scene):
    scene.add(read_model(BARBELL, "barbell", pose3(-2.0, 0.0, 0.2, yaw=math.pi / 2.0)).bodies)
    assert scene.models.links_of("barbell") == ["barbell::a", "barbell::b"]
    assert scene.models.state("barbell").pose == pytest.approx(pose3(-2.0, 0.0, 0.2, yaw=math.pi / 2.0))
    scene.set_model_state("barbell", at_rest(pose3(1.0, 1.0, 0.2)))
    assert scene.models.state("barbell").pose == pytest.approx(pose3(1.0, 1.0, 0.2))
    assert scene.models.link_state("barbell::b").pose == pytest.approx(pose3(1.0, 0.0, 0.2))


def test_a_model_in_motion_keeps_moving(scene):
    moving = KinematicState(pose3(0.0, -3.0, 2.0), np.array([1.0, 0.0, 0.0]), np.zeros(3))
    scene.set_model_state("crate", moving)
    drive(scene, 0.2)
    assert scene.models.state("crate").pose[0, 3] == pytest.approx(0.2, abs=0.01)
    assert scene.models.state("crate").linear[2] == pytest.approx(-9.8 * 0.2, rel=0.05)


@pytest.mark.parametrize("mass", [0.0, -1.0, np.nan, np.inf, 1e300])
@pytest.mark.parametrize("moment", [1.0, np.inf])
def test_a_mass_or_moment_that_is_not_positive_and_finite_is_refused(scene, mass, moment):
    with pytest.raises(WorldError, match="must be positive"):
        scene.models.set_mass("crate::link", mass, (1.0, 1.0, moment), has_gravity=True)
    drive(scene, 0.1)
    assert np.isfinite(scene.models.state("crate").pose).all()


def test_two_bodies_with_the_same_name_are_refused_and_neither_is_added(scene):
    with pytest.raises(WorldError, match="2 times"):
        scene.add([box("pair", 8.0), box("pair", 9.0)])
    assert "pair" not in scene.models.names()


def chain_of(count):
    """Return bodies and joints of a post ahead of the robot, and of a chain of hinged links above it."""
    ends = "<parent>l{}</parent><child>l{}</child><axis><xyz>0 0 1</xyz></axis>"
    ball = "<geometry><sphere><radius>0.2</radius></sphere></geometry>"
    solid = f"<inertial><mass>1</mass></inertial><collision name='c'>{ball}</collision>"
    links = "".join(f"<link name='l{i}'><pose>0 0 {2 + i} 0 0 0</pose>{solid}</link>" for i in range(count))
    joints = [f"<joint name='j{i}' type='revolute'>{ends.format(i, i + 1)}</joint>" for i in range(count - 1)]
    post = f"<link name='post'>{solid}</link>"
    xml = f"<sdf version='1.6'><model name='m'>{post}{links}{''.join(joints)}</model></sdf>"
    model = read_model(xml, "chain", pose3(1.0, 0.0, 0.2))
    return model.bodies, model.joints


def test_a_multibody_with_too_many_parts_is_refused_and_nothing_is_added(scene):
    """Of the two multibodies of this model only the second is too large."""
    scene.add_robot("one", LIDAR)
    with pytest.raises(
        WorldError, match="chain::l0: 129 parts are connected by joints, at most 128 are supported"
    ):
        scene.add(*chain_of(129))
    seen = drive(scene, 4.0, {"one": Twist2(0.5, 0.0)})["one"]
    assert seen.base_in_world.x > 1.5
    scene.remove_model("one")
    scene.add(*chain_of(128))
    assert len(scene.models.links_of("chain")) == 129


def test_a_model_cannot_have_the_name_of_a_robot(scene):
    scene.add_robot("r", LIDAR)
    with pytest.raises(WorldError, match="r is in the world already"):
        scene.add([box("r", 8.0)])


def test_gravity_can_be_switched_off(scene):
    scene.set_gravity(0.0)
    scene.set_model_state("crate", at_rest(pose3(0.0, -3.0, 2.0)))
    drive(scene, 0.5)
    assert scene.models.state("crate").pose[2, 3] == pytest.approx(2.0)


def test_a_static_model_that_is_moved_is_scanned_at_its_new_pose(scene):
    scene.add_robot("r", LIDAR)
    scene.set_model_state("wall", at_rest(pose3(2.0, 0.0, 0.25)))
    assert drive(scene, 0.1)["r"].scan.ranges[180] == pytest.approx(1.75, abs=1e-3)
    scene.remove_model("wall")
    assert math.isinf(drive(scene, 0.1)["r"].scan.ranges[180])
    with pytest.raises(UnknownEntityError, match="no model named 'wall'"):
        scene.models.state("wall")


def test_a_static_model_that_is_moved_before_the_first_image_is_rendered_at_its_new_pose(scene):
    scene.set_model_state("wall", at_rest(pose3(2.0, 0.0, 0.25)))
    triangles, _ = scene.view.triangles()
    assert triangles[..., 0][triangles[..., 2] > 0.4].min() == pytest.approx(1.75)


def test_a_model_may_be_removed_while_a_wrench_acts_on_it(scene):
    scene.forces.apply_link_wrench(
        LinkWrench("crate::link", np.array([4.0, 0.0, 0.0]), np.zeros(3), 0.0, math.inf)
    )
    scene.remove_model("crate")
    scene.step()
    assert "crate" not in scene.models.names()


def test_unknown_names_are_refused_with_the_nearest_one(scene):
    with pytest.raises(UnknownEntityError, match="no model named 'crat' .did you mean \"crate\""):
        scene.remove_model("crat")
    with pytest.raises(UnknownEntityError, match='did you mean "crate::link"'):
        scene.models.link_state("crate::lnk")
    with pytest.raises(UnknownEntityError, match="no robot named 'r'"):
        scene.step({"r": Twist2()})


def test_a_wrench_acts_for_the_given_time_and_can_be_cleared(scene):
    scene.set_gravity(0.0)
    scene.set_model_state("crate", at_rest(pose3(0.0, -3.0, 2.0)))
    scene.forces.apply_link_wrench(
        LinkWrench("crate::link", np.array([4.0, 0.0, 0.0]), np.zeros(3), 0.0, 0.5)
    )
    drive(scene, 1.0)
    assert scene.models.state("crate").linear[0] == pytest.approx(4.0 / 2.0 * 0.5, rel=0.05)
    scene.forces.apply_link_wrench(
        LinkWrench("crate::link", np.array([4.0, 0.0, 0.0]), np.zeros(3), 0.0, math.inf)
    )
    scene.forces.clear_link_wrenches("crate::link")
    drive(scene, 1.0)
    assert scene.models.state("crate").linear[0] == pytest.approx(1.0, rel=0.1)


def test_robots_scan_each_other_and_collide(scene):
    scene.add_robot("one", LIDAR, Pose2(-1.0, 0.0, 0.0))
    scene.add_robot("two", LIDAR, Pose2(1.0, 0.0, math.pi))
    seen = drive(scene, 0.1)
    assert seen["one"].scan.ranges[180] == pytest.approx(2.0 - 0.05, abs=0.01), "the other's lidar"
    seen = drive(scene, 6.0, {"one": Twist2(0.5, 0.0)})
    assert "two::base_footprint" in seen["one"].contacts
    assert seen["one"].base_in_world.distance_to(seen["two"].base_in_world) > 2 * 0.178 - 0.01


def test_two_robots_follow_separate_commands(scene):
    scene.add_robot("one", LIDAR, Pose2(0.0, 0.0))
    scene.add_robot("two", LIDAR, Pose2(0.0, 1.0))
    seen = drive(scene, 3.0, {"one": Twist2(0.3, 0.0), "two": Twist2(-0.3, 0.0)})
    assert seen["one"].base_in_world.x > 0.7
    assert seen["two"].base_in_world.x < -0.7


def test_a_robot_needs_free_space_and_a_unique_name(scene):
    scene.add_robot("one", LIDAR)
    with pytest.raises(WorldError, match="one is in the world already"):
        scene.add_robot("one", LIDAR, Pose2(1.0, 0.0))
    with pytest.raises(WorldError, match="inside one::base_footprint"):
        scene.add_robot("two", LIDAR, Pose2(0.1, 0.0))
    assert "two" not in scene.models.names()
    assert drive(scene, 0.5)["one"].contacts == (), "nothing of it is left in the engine either"


def test_resetting_poses_restores_the_start_poses_and_time_continues(scene):
    scene.add_robot("r", LIDAR, Pose2(1.0, 0.0))
    scene.set_model_state("crate", at_rest(pose3(0.0, -3.0, 0.25)))
    before = drive(scene, 2.0, {"r": Twist2(0.4, 0.0)})["r"]
    scene.reset_poses()
    after = scene.step()["r"]
    assert after.stamp > before.stamp
    assert after.base_in_world.distance_to(Pose2(1.0, 0.0)) < 0.01
    assert after.odometry.base_in_odom.distance_to(before.odometry.base_in_odom) < 0.02, "it never jumps"
    assert scene.models.state("crate").pose == pytest.approx(pose3(3.0, 2.0, 0.25), abs=1e-2)


def walled(seed):
    floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
    scene = Scene(World("w", (floor, box("wall", 3.0), box("crate", 0.9, 0.2, mass=2.0))), seed=seed)
    scene.add_robot("r", LIDAR)
    return scene


def trace(scene, command=Twist2(0.3, 0.4)):
    seen = []
    for _ in range(100):
        one = scene.step({"r": command})["r"]
        seen.append((one.stamp, one.base_in_world, one.odometry))
        if one.scan is not None:
            seen.append(one.scan.ranges.tobytes())
    return seen


def test_a_reset_scene_repeats_its_run_bit_for_bit():
    scene = walled(seed=3)
    first = trace(scene)
    scene.reset()
    assert trace(scene) == first


def test_rewind_restores_the_marked_state_whatever_has_happened_since():
    scene, fresh, start = walled(seed=3), walled(seed=8), {"r": Pose2(0.1, -0.2, 0.3)}
    for one in (scene, fresh):
        one.mark()
    trace(scene, Twist2(0.5, 0.1))  # into the crate
    assert scene.models.state("crate").pose[0, 3] > 1.0
    runs = []
    for one, seed in ((scene, 4), (scene, 5), (scene, 4), (fresh, 4)):
        one.rewind(seed, start)
        runs.append(trace(one))
    assert runs[0] == runs[2] == runs[3] != runs[1]
    assert runs[0][0][1].distance_to(start["r"]) < 0.01


def test_the_physics_rate_can_be_changed_and_time_continues(scene):
    drive(scene, 0.5)
    scene.set_physics_rate(1000)
    drive(scene, 0.5)
    assert scene.stamp == pytest.approx(1.0)
    with pytest.raises(SettingsError, match="divisor of physics_rate"):
        scene.set_physics_rate(77)


@pytest.mark.parametrize("pair", [("wall::link", "crate::link"), ("crate::link", "wall::link")])
def test_a_static_body_holds_and_moves_what_is_attached_to_it(scene, pair):
    scene.set_model_state("crate", at_rest(pose3(5.0, 1.0, 1.5)))
    scene.attach(*pair)
    drive(scene, 1.0)
    np.testing.assert_allclose(scene.models.state("crate").pose[:3, 3], (5.0, 1.0, 1.5), atol=0.01)
    scene.set_model_state("wall", at_rest(pose3(6.0, 0.0, 0.25)))
    drive(scene, 2.0)
    np.testing.assert_allclose(scene.models.state("crate").pose[:3, 3], (6.0, 1.0, 1.5), atol=0.01)
    scene.detach(*pair)
    drive(scene, 2.0)
    assert scene.models.state("crate").pose[2, 3] == pytest.approx(0.25, abs=0.01)
    assert scene.models.state("wall").pose == pytest.approx(pose3(6.0, 0.0, 0.25))


def test_two_static_bodies_can_be_attached_and_detached(scene):
    scene.attach("wall::link", "floor::link")
    drive(scene, 0.1)
    scene.detach("wall::link", "floor::link")
    assert scene.models.state("wall").pose == pytest.approx(pose3(5.0, 0.0, 0.25))


@pytest.mark.parametrize("has_gravity", [True, False])
def test_a_static_body_stays_whatever_mass_and_velocity_are_set(scene, has_gravity):
    up = pose3(5.0, 0.0, 1.25)
    scene.models.set_mass("wall::link", 3.0, (0.1, 0.2, 0.3), has_gravity)
    scene.set_model_state("wall", KinematicState(up, np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])))
    drive(scene, 1.0)
    assert scene.models.state("wall").pose == pytest.approx(up)
    assert not scene.models.state("wall").linear.any()
    properties = scene.models.mass_properties("wall::link")
    assert (properties.mass, *properties.moments, properties.has_gravity) == (3.0, 0.1, 0.2, 0.3, has_gravity)


def test_a_body_attached_to_a_robot_moves_with_it_until_it_is_detached(scene):
    scene.add_robot("robot", LIDAR)
    scene.add([box("parcel", 0.0, mass=0.2)])
    scene.set_model_state("parcel", at_rest(pose3(z=0.7)))
    base = scene.models.links_of("robot")[0]
    scene.attach(base, "parcel::link")
    observation = drive(scene, 4.0, {"robot": Twist2(0.5, 0.4)})
    parcel_in_base = (
        np.linalg.inv(scene.models.link_state(base).pose) @ scene.models.link_state("parcel::link").pose
    )
    assert math.hypot(observation["robot"].base_in_world.x, observation["robot"].base_in_world.y) > 1.0
    np.testing.assert_allclose(parcel_in_base[:3, 3], (0.0, 0.0, 0.7), atol=0.01)
    assert observation["robot"].contacts == ()
    scene.detach(base, "parcel::link")
    scene.set_model_state("parcel", at_rest(pose3(3.0, -2.0, 1.0)))
    drive(scene, 1.0)
    assert scene.models.state("parcel").pose[2, 3] == pytest.approx(0.25, abs=0.01)
    with pytest.raises(UnknownEntityError, match="parcel::link is not attached"):
        scene.detach(base, "parcel::link")
