"""Statements of SDF's specification: the files of sdformat's sdf/1.6, unless another version is named."""

import math

import numpy as np
import pytest

from sim_bridge.description import read_sdf_robot
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Mesh, Plane
from sim_bridge.sdf import load_world, read_model

SHAPE = "<geometry><box><size>1 1 1</size></box></geometry>"
COLLISION = f"<collision name='c'>{SHAPE}</collision>"
HINGE = (
    "<link name='a'>{0}</link><link name='b'><pose>1 0 0 0 0 0</pose>{0}</link>"
    "<joint name='j' type='revolute'><parent>a</parent><child>b</child>{1}</joint>"
)
LASER = """<link name='base'><inertial><mass>5</mass></inertial>{0}<sensor name='s' type='ray'>{1}<ray><scan>
<horizontal><samples>9</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan>
<range><min>0.1</min><max>5</max></range>{2}</ray>
<plugin name='p' filename='libgazebo_ros_laser.so'>{3}</plugin></sensor></link>
<plugin name='d' filename='libgazebo_ros_planar_move.so'/>"""


def world_of(tmp_path, content, version="1.6", **options):
    path = tmp_path / "statement.world"
    path.write_text(f"<sdf version='{version}'><world name='w'>{content}</world></sdf>")
    return load_world(path, **options)


def body_of(content, version="1.6"):
    (body,) = model_of(f"<link name='l'>{content}</link>", version).bodies
    return body


def model_of(content, version="1.6"):
    return read_model(f"<sdf version='{version}'><model name='m'>{content}</model></sdf>", "m", np.eye(4))


def surface_of(content):
    return body_of(f"<collision name='c'>{SHAPE}<surface>{content}</surface></collision>").surface


def robot_of(pose="", noise="", plugin="", rate=""):
    (model,) = model_of(LASER.format(COLLISION, pose + rate, noise, plugin)).robots
    return read_sdf_robot(model)[0]


def test_an_empty_pose_is_the_identity():
    """pose.sdf: default 0 0 0 0 0 0."""
    assert body_of("<pose/>" + COLLISION).pose_in_world == pytest.approx(np.eye(4))


def test_angles_of_a_pose_are_fixed_axis_roll_pitch_yaw():
    """pose.sdf, and sdformat.org, specify_pose."""
    body = body_of("<pose>0 0 0 1.5707963 0 1.5707963</pose>" + COLLISION)
    assert body.pose_in_world[:3, :3] @ [0.0, 1.0, 0.0] == pytest.approx([0.0, 0.0, 1.0], abs=1e-6)


def test_degrees_of_a_pose_default_to_false():
    """pose.sdf 1.9: degrees."""
    for attribute, yaw in (("", 1.0), (" degrees='0'", 1.0), (" degrees='true'", math.radians(1.0))):
        pose = body_of(f"<pose{attribute}>0 0 0 0 0 1</pose>" + COLLISION, "1.9").pose_in_world
        assert pose == pytest.approx(pose3(yaw=yaw)), attribute


def test_a_pose_may_be_a_quaternion_of_x_y_z_w():
    """pose.sdf 1.9: rotation_format quat_xyzw."""
    pose = body_of("<pose rotation_format='quat_xyzw'>1 2 3 0 0 1 1</pose>" + COLLISION, "1.9").pose_in_world
    assert pose == pytest.approx(pose3(1.0, 2.0, 3.0, yaw=math.pi / 2.0))


def test_a_pose_may_be_relative_to_a_frame():
    """pose.sdf 1.7: relative_to."""
    frame = "<frame name='f'><pose>1 0 0 0 0 1.5707963267948966</pose></frame>"
    link = f"<link name='l'><pose relative_to='f'>1 0 0 0 0 0</pose>{COLLISION}</link>"
    (body,) = model_of(frame + link, "1.7").bodies
    assert body.pose_in_world == pytest.approx(pose3(1.0, 1.0, yaw=math.pi / 2.0))


def test_a_link_has_a_mass_of_1_kg_by_default():
    """inertial.sdf: mass default 1.0."""
    assert body_of(COLLISION).mass == 1.0


def test_the_matrix_of_inertia_is_that_about_the_centre_of_mass():
    """inertial.sdf: in the inertial frame, default 1 on the diagonal."""
    content = "<inertial><pose>0.1 0 0 0 0 0</pose><inertia><ixx>2</ixx><iyy>3</iyy></inertia></inertial>"
    inertia = body_of(content + COLLISION).inertia
    assert inertia.pose_in_body[:3, 3] == pytest.approx([0.1, 0.0, 0.0])
    assert sorted(inertia.moments) == pytest.approx([1.0, 2.0, 3.0])


def test_gravity_acts_on_a_link_by_default():
    """link.sdf: gravity default true."""
    assert body_of(COLLISION).has_gravity
    assert not body_of("<gravity>false</gravity>" + COLLISION).has_gravity


def test_the_gravity_of_a_world_defaults_to_9_8_downwards(tmp_path):
    """world.sdf 1.6: gravity default 0 0 -9.8."""
    assert world_of(tmp_path, "").gravity == 9.8
    assert world_of(tmp_path, "<gravity>0 0 -1.6</gravity>").gravity == 1.6


def test_gravity_in_physics_is_that_of_sdf_before_1_6(tmp_path):
    """physics.sdf 1.5: gravity."""
    assert world_of(tmp_path, "<physics type='ode'><gravity>0 0 -3</gravity></physics>", "1.5").gravity == 3.0


def test_gravity_that_is_not_vertical_is_named(tmp_path):
    """world.sdf: gravity is a vector. Stated difference: only its z acts."""
    (text,) = world_of(tmp_path, "<gravity>1 0 -9</gravity>").warnings
    assert text.endswith("statement.world:1: sdf > world 'w' > gravity: only its z acts")


def test_friction_is_1_by_default():
    """surface.sdf: mu and mu2 default 1."""
    assert body_of(COLLISION).surface.friction == 1.0
    assert surface_of("<friction><ode><mu>0.5</mu></ode></friction>").friction == 0.5


@pytest.mark.parametrize("mu", [100.0, 0.05, 0.0])
def test_friction_is_not_clipped_to_1(mu):
    """surface.sdf: mu has no maximum."""
    assert surface_of(f"<friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction>").friction == mu


def test_friction_of_two_directions_is_the_smaller_one_and_named():
    """surface.sdf: mu2 is for the second direction. Stated difference: Bullet has one coefficient."""
    surface = "<surface><friction><ode><mu>0.5</mu><mu2>0.2</mu2></ode></friction></surface>"
    world = model_of(f"<link name='l'><collision name='c'>{SHAPE}{surface}</collision></link>")
    assert world.bodies[0].surface.friction == 0.2
    assert "mu 0.5 and mu2 0.2 differ: the smaller one acts in all directions" in world.warnings[0]


def test_a_surface_does_not_bounce_by_default():
    """surface.sdf: restitution_coefficient default 0, between 0 and 1."""
    assert body_of(COLLISION).surface.restitution == 0.0
    for given, expected in ((0.7, 0.7), (3.0, 1.0)):
        text = f"<bounce><restitution_coefficient>{given}</restitution_coefficient></bounce>"
        assert surface_of(text).restitution == expected


def test_the_threshold_of_a_bounce_is_read():
    """surface.sdf: threshold. Stated difference: without one, it bounces (the default is 100000 m/s)."""
    text = "<bounce><restitution_coefficient>1</restitution_coefficient>{}</bounce>"
    assert surface_of(text.format("<threshold>2</threshold>")).bounce_threshold == 2.0
    assert surface_of(text.format("")).bounce_threshold is None


def test_velocity_decay_refers_to_the_step_of_physics(tmp_path):
    """link.sdf: velocity_decay; ODE multiplies by 1 - decay in each max_step_size (default 0.001 s)."""
    link = f"<link name='l'><velocity_decay><linear>0.01</linear></velocity_decay>{COLLISION}</link>"
    for physics, step in (("", 0.001), ("<physics><max_step_size>0.002</max_step_size></physics>", 0.002)):
        world = world_of(tmp_path, physics + f"<model name='m'>{link}</model>")
        assert world.bodies[0].damping == (pytest.approx(-math.log(0.99) / step), 0.0)


def test_velocity_decay_of_a_link_that_hangs_on_a_joint_is_named():
    """link.sdf: velocity_decay. Stated difference: it acts on the root of a tree of links."""
    decay = "<velocity_decay><angular>0.1</angular></velocity_decay>"
    (text,) = model_of(HINGE.format(COLLISION + decay, "<axis/>")).warnings
    assert text.endswith("link 'b' > velocity_decay: has no effect on a link that hangs on a joint")


def test_a_plane_is_infinite_and_static_whatever_its_size():
    """plane_shape.sdf: size is that of the visual."""
    body = body_of("<collision name='c'><geometry><plane><size>1 1</size></plane></geometry></collision>")
    assert body.collisions[0].shape == Plane((0.0, 0.0, 1.0))
    assert body.mass is None


def test_a_polyline_has_a_height_of_1_m_by_default():
    """polyline_shape.sdf."""
    points = "".join(f"<point>{x} {y}</point>" for x, y in ((0, 0), (1, 0), (0, 1)))
    shape = f"<geometry><polyline>{points}</polyline></geometry>"
    mesh = body_of(f"<collision name='c'>{shape}</collision>").collisions[0].shape
    assert isinstance(mesh, Mesh)
    assert mesh.vertices[:, 2].max() == 1.0


def test_what_is_in_a_static_model_does_not_move():
    """model.sdf: static."""
    (body,) = model_of(f"<static>true</static><link name='l'>{COLLISION}</link>").bodies
    assert body.is_static


def test_an_axis_is_z_and_without_limits_by_default():
    """joint.sdf: xyz default 0 0 1, lower -1e16, upper 1e16."""
    (joint,) = model_of(HINGE.format(COLLISION, "<axis><limit/></axis>")).joints
    assert joint.axis.tolist() == [0.0, 0.0, 1.0]
    assert (joint.lower, joint.upper, joint.effort) == (-math.inf, math.inf, math.inf)


def test_the_pose_of_a_joint_is_in_its_child():
    """joint.sdf: pose."""
    (joint,) = model_of(HINGE.format(COLLISION, "<pose>-0.5 0 0 0 0 0</pose><axis/>")).joints
    assert joint.pose_in_child == pytest.approx(pose3(-0.5))


def test_an_axis_is_in_the_joint_frame_since_1_5_and_in_the_model_before():
    """joint.sdf: use_parent_model_frame, 1.4 to 1.6."""
    turned = "<pose>0 0 0 0 0 1.5707963267948966</pose><axis><xyz>1 0 0</xyz>{}</axis>"
    parent = "<use_parent_model_frame>1</use_parent_model_frame>"
    for version, flag, axis in (("1.6", "", (1, 0, 0)), ("1.6", parent, (0, -1, 0)), ("1.4", "", (0, -1, 0))):
        (joint,) = model_of(HINGE.format(COLLISION, turned.format(flag)), version).joints
        assert joint.axis == pytest.approx(axis, abs=1e-6), version + flag


def test_the_damping_and_friction_of_an_axis_are_read():
    """joint.sdf: dynamics."""
    dynamics = "<axis><dynamics><damping>0.3</damping><friction>0.2</friction></dynamics></axis>"
    (joint,) = model_of(HINGE.format(COLLISION, dynamics)).joints
    assert (joint.damping, joint.friction) == (0.3, 0.2)


def test_a_negative_effort_is_no_limit():
    """joint.sdf: a negative value means that the effort is not limited."""
    for given, expected in ((-1, math.inf), (3, 3.0)):
        axis = f"<axis><limit><effort>{given}</effort></limit></axis>"
        assert model_of(HINGE.format(COLLISION, axis)).joints[0].effort == expected


def test_a_sensor_stands_where_its_pose_places_it_in_the_link():
    """sensor.sdf: pose."""
    robot = robot_of(pose="<pose>0.1 0 0.3 0 0.2 0</pose>")
    assert robot.laser.pose_in_base == pytest.approx(pose3(0.1, 0.0, 0.3, pitch=0.2))


def test_a_laser_without_update_rate_is_as_fast_as_the_simulation():
    """sensor.sdf: update_rate default 0."""
    assert robot_of().laser.rate is None
    assert robot_of(rate="<update_rate>7</update_rate>").laser.rate == 7.0


def test_the_noise_of_a_laser_has_mean_and_deviation():
    """ray.sdf, noise.sdf: type gaussian."""
    laser = robot_of(noise="<noise><mean>0.1</mean><stddev>0.02</stddev></noise>").laser
    assert (laser.noise_mean, laser.noise) == (0.1, 0.02)


@pytest.mark.parametrize("value", ["0", "1", "true", "false", "True"])
def test_truth_values_are_numbers_or_words(value):
    """The type bool of SDF."""
    assert body_of(f"<kinematic>{value}</kinematic>" + COLLISION).is_static == (
        value.lower() in ("1", "true")
    )


@pytest.mark.parametrize(
    "content",
    [
        "<gui><camera name='c'/></gui><scene><ambient>1 1 1 1</ambient></scene>",
        "<physics type='ode'><ode><solver><iters>100</iters></solver></ode></physics>",
        "<spherical_coordinates><latitude_deg>1</latitude_deg></spherical_coordinates>",
        "<model name='m'><allow_auto_disable>1</allow_auto_disable><self_collide>0</self_collide>{}</model>",
        "<model name='m'><link name='l'><collision name='c'>{shape}<max_contacts>10</max_contacts><surface>"
        "<contact><collide_bitmask>0xffff</collide_bitmask><ode><kp>1e6</kp></ode></contact><bounce/>"
        "<friction><ode><fdir1>0 0 0</fdir1><slip1>0</slip1></ode><torsional><ode/></torsional></friction>"
        "</surface></collision></link></model>",
        "<model name='m'><link name='l'><visual name='v'>{shape}<cast_shadows>0</cast_shadows>"
        "<material><script><name>Gazebo/Red</name><uri>file://media</uri></script></material></visual></link>"
        "</model>",
    ],
)
def test_what_does_not_matter_for_a_robot_needs_no_notice(tmp_path, content):
    """Solver, window, scenery, and SDF's defaults (docs/reference/worlds.md)."""
    text = content.replace("{shape}", SHAPE).replace("{}", f"<link name='l'>{COLLISION}</link>")
    assert world_of(tmp_path, text).warnings == ()


@pytest.mark.parametrize(
    ("content", "place"),
    [
        ("<road name='r'/>", "world 'w' > road 'r'"),
        ("<model name='m'><link name='l'><battery name='b'/></link></model>", "link 'l' > battery 'b'"),
        ("<model name='m'><frction>1</frction><link name='l'/></model>", "model 'm' > frction"),
        (
            "<model name='m'><self_collide>1</self_collide><link name='l'/></model>",
            "model 'm' > self_collide",
        ),
        (
            f"<model name='m'><link name='l'><collision name='c'>{SHAPE}<surface><friction><ode>"
            "<slip1>0.1</slip1></ode></friction></surface></collision></link></model>",
            "ode > slip1",
        ),
        (
            f"<model name='m'><link name='l'><collision name='c'>{SHAPE}<surface><contact>"
            "<collide_without_contact>1</collide_without_contact></contact></surface></collision></link></model>",
            "surface > contact",
        ),
        (
            "<model name='m'>"
            + HINGE.format(COLLISION, "<axis><limit><velocity>2</velocity></limit></axis>")
            + "</model>",
            "limit > velocity",
        ),
        (
            "<model name='m'><link name='l'/><plugin name='p' filename='libhover.so'/></model>",
            "plugin 'p' (libhover.so)",
        ),
    ],
)
def test_what_has_no_effect_is_named_once_with_file_and_line_and_an_error_if_strict(tmp_path, content, place):
    """Stated difference: Gazebo's parser passes over unknown elements."""
    (text,) = world_of(tmp_path, "\n" + content).warnings
    assert text.startswith(f"{tmp_path}/statement.world:2: sdf > world 'w'")
    assert text.endswith(f"{place}: has no effect")
    with pytest.raises(WorldError, match="has no effect\nremove what has no effect, or do without strict"):
        world_of(tmp_path, "\n" + content, strict=True)


def test_a_parameter_of_a_plugin_that_nothing_reads_is_named():
    """gazebo_ros_laser has no such parameter."""
    (text,) = robot_of(plugin="<gaussianNoise>0.1</gaussianNoise>").warnings
    assert text.endswith("sensor 's' > plugin 'p' > gaussianNoise: has no effect")


def test_a_pose_that_does_not_have_six_numbers_is_an_error():
    """pose.sdf."""
    with pytest.raises(WorldError, match="expected 6 finite numbers"):
        body_of("<pose>1 2 3</pose>" + COLLISION)
