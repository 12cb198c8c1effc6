"""SDF worlds are read by the rules of SDF."""

import math
import time

import numpy as np
import pytest

from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Box, Cylinder, Mesh, Plane, Sphere
from sim_bridge.sdf import load_world, read_model
from sim_bridge.sdf.element import Element

UNIT_BOX = "<geometry><box><size>1 1 1</size></box></geometry>"


@pytest.fixture
def load(tmp_path):
    """Load the text between <world> and </world>."""

    def _load(content, **arguments):
        path = tmp_path / "test.world"
        path.write_text(f"<?xml version='1.0'?><sdf version='1.6'><world name='w'>{content}</world></sdf>")
        return load_world(path, **arguments)

    return _load


def model(content=f"<link name='l'><collision name='c'>{UNIT_BOX}</collision></link>", name="m"):
    return f"<model name='{name}'><static>1</static>{content}</model>"


def geometry(shape):
    return model(f"<link name='l'><collision name='c'><geometry>{shape}</geometry></collision></link>")


@pytest.mark.parametrize(
    ("text", "shape"),
    [
        ("<box><size>1 2 3</size></box>", Box((1.0, 2.0, 3.0))),
        ("<box><size>1 0 3</size></box>", Box((1.0, 1e-4, 3.0))),  # as thin as Gazebo makes it
        ("<cylinder><radius>0.5</radius><length>2</length></cylinder>", Cylinder(0.5, 2.0)),
        ("<sphere><radius>0.5</radius></sphere>", Sphere(0.5)),
        ("<plane><normal>0 1 0</normal><size>9 9</size></plane>", Plane((0.0, 1.0, 0.0))),
    ],
)
def test_primitive_shapes_are_read(load, text, shape):
    (body,) = load(geometry(text)).bodies
    assert body.collisions[0].shape == shape


def test_poses_of_model_link_and_collision_are_composed(load):
    world = load(
        "<model name='m'><static>1</static><pose>1 0 0 0 0 1.5707963267948966</pose><link name='l'>"
        "<pose>2 0 0 0 0 0</pose><collision name='c'><pose>0 0 3 0 0 0</pose>"
        f"{UNIT_BOX}</collision></link></model>"
    )
    (body,) = world.bodies
    in_world = body.pose_in_world @ body.collisions[0].pose_in_body
    assert in_world == pytest.approx(pose3(1.0, 2.0, 3.0, yaw=math.pi / 2.0))


def test_state_overrides_the_poses_of_models_and_their_links(load):
    links = "".join(f"<link name='{name}'><collision name='c'>{UNIT_BOX}</collision></link>" for name in "ab")
    world = load(
        f"<model name='m'><static>1</static><pose>9 9 9 0 0 0</pose>{links}</model>"
        "<state world_name='w'><model name='m'><pose>1 0 0 0 0 0</pose>"
        "<link name='b'><pose>5 0 0 0 0 0</pose></link></model></state>"
    )
    a, b = world.bodies
    assert a.pose_in_world == pytest.approx(pose3(1.0))
    assert b.pose_in_world == pytest.approx(pose3(5.0)), "poses of links in <state> are in the world frame"


def test_state_adds_inserted_models_and_drops_deleted_ones(load):
    world = load(
        model(name="old")
        + f"<state world_name='w'><insertions>{model(name='new')}</insertions>"
        + "<deletions><name>old</name></deletions></state>"
    )
    assert [body.name for body in world.bodies] == ["new::l"]


def test_nested_models_stand_in_their_parent_and_carry_its_name(load):
    link = f"<link name='l'><collision name='c'>{UNIT_BOX}</collision></link>"
    inner = f"<model name='in'><pose>0 1 0 0 0 0</pose>{link}</model>"
    (body,) = load(model(f"<pose>1 0 0 0 0 0</pose>{inner}")).bodies
    assert body.name == "m::in::l"
    assert body.mass is None, "what is nested in a static model is static"
    assert body.pose_in_world == pytest.approx(pose3(1.0, 1.0))


def test_what_is_not_static_has_a_mass(load):
    parts = f"<inertial><mass>2.5</mass></inertial><collision name='c'>{UNIT_BOX}</collision>"
    assert load(f"<model name='m'><link name='l'>{parts}</link></model>").bodies[0].mass == 2.5


def test_ground_plane_and_sun_are_built_in(load):
    world = load(
        "<include><uri>model://sun</uri></include><include><uri>model://ground_plane</uri></include>"
    )
    assert [body.name for body in world.bodies] == ["ground_plane::link"]
    assert world.warnings == ()


def add_model(folder, name, content):
    (folder / name).mkdir(parents=True)
    (folder / name / "model.config").write_text(
        "<?xml version='1.0'?><model><name>x</name><sdf version='1.4'>old.sdf</sdf>"
        "<sdf version='1.6'>model.sdf</sdf></model>"
    )
    (folder / name / "model.sdf").write_text(f"<sdf version='1.6'>{content}</sdf>")


def test_includes_are_found_in_the_model_folders(load, tmp_path):
    add_model(tmp_path / "models", "chair", model(name="chair"))
    world = load(
        "<include><uri>model://chair</uri><name>mine</name><pose>1 2 0 0 0 0</pose></include>",
        model_folders=[tmp_path / "nowhere", tmp_path / "models"],
    )
    (body,) = world.bodies
    assert body.name == "mine::l"
    assert body.pose_in_world == pytest.approx(pose3(1.0, 2.0))


@pytest.mark.parametrize(
    "scheme", ["file://{}/chair", "{}/chair", "chair", "file://chair", "chair/model.sdf"]
)
def test_includes_are_found_by_path_and_may_be_made_static(load, tmp_path, scheme):
    content = "<model name='chair'><pose>9 9 9 0 0 0</pose><link name='l'/></model>"
    add_model(tmp_path, "chair", content)
    include = f"<include><uri>{scheme.format(tmp_path)}</uri>{{}}</include>"
    (still,) = load(include.format("<static>true</static>")).bodies
    assert still.mass is None
    assert still.pose_in_world == pytest.approx(
        pose3(9.0, 9.0, 9.0)
    ), "the model's own pose if there is no other"
    (loose,) = load(include.format("")).bodies
    assert loose.mass == 1.0


@pytest.mark.parametrize(
    "library", ["libgazebo_ros_init.so", "libgazebo_ros_factory.so", "libactor_collisions.so"]
)
def test_world_plugins_that_are_not_needed_are_ignored_without_a_warning(load, library):
    assert load(f"<plugin name='p' filename='{library}'/>" + model()).warnings == ()


def test_a_bracket_in_an_attribute_is_read_as_gazebo_reads_it(load):
    world = load("<plugin name='<hello>' filename=\"lib<hello>.so\"/>" + model())
    assert len(world.bodies) == 1
    assert "plugin '<hello>'" in world.warnings[0]


def test_an_include_that_includes_itself_is_an_error(load, tmp_path):
    add_model(tmp_path, "loop", "<model name='loop'><include><uri>model://loop</uri></include></model>")
    with pytest.raises(WorldError, match="includes itself"):
        load("<include><uri>model://loop</uri></include>", model_folders=[tmp_path])


@pytest.mark.parametrize(
    ("content", "named"),
    [
        ("<plugin name='p' filename='libhello.so'/>", "plugin 'p' (libhello.so)"),
        ("<include><uri>model://unicorn</uri></include>", "model://unicorn"),
        (geometry("<mesh><uri>model://no/a.dae</uri></mesh>"), "model://no/a.dae"),
        (geometry("<heightmap><uri>a.png</uri></heightmap>"), "<heightmap>"),
        ("<population name='crowd'/>", "population 'crowd'"),
    ],
)
def test_unsupported_content_is_ignored_with_a_warning_and_the_rest_is_loaded(load, content, named):
    world = load(content + model(name="rest"))
    assert world.bodies[-1].name == "rest::l"
    assert not any(body.collisions for body in world.bodies[:-1])
    assert len(world.warnings) == 1
    assert named in world.warnings[0]


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (
            geometry("<box><size>1 -1 1</size></box>"),
            "collision 'c' > geometry > box > size: must be positive",
        ),
        (geometry("<box><size>1 1</size></box>"), "expected 3 finite numbers, got '1 1'"),
        (geometry("<cylinder><radius>1</radius></cylinder>"), "<length> is missing"),
        (model("<pose>nan 0 0 0 0 0</pose>"), "model 'm' > pose: expected 6 finite numbers"),
        (model("<pose>a b c 0 0 0</pose>"), "model 'm' > pose: expected 6 numbers"),
        (geometry("<plane><normal>0 0 0</normal></plane>"), "normal"),
    ],
)
def test_errors_about_values_that_are_not_valid_name_file_and_element(load, content, named):
    with pytest.raises(WorldError, match="test.world") as caught:
        load(content)
    assert named in str(caught.value)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<sdf><world", "not well-formed"),
        ("", "not well-formed"),
        ("<robot/>", "<robot>"),
        ("<sdf version='1.6'/>", "<world> is missing"),
        ("<!DOCTYPE x [<!ENTITY a 'b'><!ENTITY c '&a;&a;'>]><sdf><world name='&c;'/></sdf>", "entities"),
    ],
)
def test_files_that_hold_no_world_are_refused(tmp_path, text, reason):
    path = tmp_path / "bad.world"
    path.write_text(text)
    with pytest.raises(WorldError, match="bad.world") as caught:
        load_world(path)
    assert reason in str(caught.value)


def test_a_missing_file_is_an_error(tmp_path):
    with pytest.raises(WorldError, match=r"nowhere\.world: cannot be read"):
        load_world(tmp_path / "nowhere.world")


def test_meshes_are_read_with_their_scale(load, tmp_path):
    (tmp_path / "tetra.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"
    )
    (body,) = load(geometry("<mesh><uri>tetra.obj</uri><scale>2 2 2</scale></mesh>")).bodies
    mesh = body.collisions[0].shape
    assert isinstance(mesh, Mesh)
    assert mesh.vertices.max() == 2.0
    assert mesh.triangles.shape == (4, 3)


def test_a_broken_mesh_is_an_error_that_names_it(load, tmp_path):
    (tmp_path / "broken.dae").write_text("<COLLADA")
    with pytest.raises(WorldError, match=r"broken\.dae"):
        load(geometry("<mesh><uri>broken.dae</uri></mesh>"))


def test_three_hundred_cylinders_load_within_a_second(load):
    shape = "<geometry><cylinder><radius>0.1</radius><length>1</length></cylinder></geometry>"
    link = f"<link name='l'><collision name='c'>{shape}</collision></link>"
    start = time.process_time()
    world = load("".join(model(link, name=f"cylinder_{number}") for number in range(300)))
    assert len(world.bodies) == 300
    assert time.process_time() - start < 1.0


def test_a_single_model_can_be_read_from_text():
    text = f"<sdf version='1.6'>{model()}</sdf>"
    (body,) = read_model(text, "mine", pose3(3.0)).bodies
    assert body.name == "mine::l"
    assert np.array_equal(body.pose_in_world, pose3(3.0))


def test_a_model_to_spawn_may_be_included_by_a_world(tmp_path):
    add_model(tmp_path, "chair", model(name="chair"))
    (tmp_path / "stool").mkdir()
    text = "<sdf version='1.4'><world name='default'><include><uri>model://{}</uri></include></world></sdf>"
    (body,) = read_model(text.format("chair"), "mine", pose3(3.0), [tmp_path]).bodies
    assert body.name == "mine::l"
    assert np.array_equal(body.pose_in_world, pose3(3.0))
    for missing in ("unicorn", "stool"):
        world = read_model(text.format(missing), "mine", pose3(), [tmp_path])
        assert world.bodies == ()
        assert f"model://{missing} not found" in world.warnings[0]


def in_world(world, name):
    (body,) = (body for body in world.bodies if body.name == name)
    return body.pose_in_world


def test_poses_may_be_given_in_other_frames(load):
    links = (
        "<link name='a'><pose>1 0 0 0 0 1.5707963267948966</pose></link>"
        "<link name='b'><pose relative_to='a'>1 0 0 0 0 0</pose></link>"
        "<frame name='shelf' attached_to='b'><pose>0 0 2 0 0 0</pose></frame>"
        "<link name='c'><pose relative_to='shelf'>0 0 1 0 0 0</pose></link>"
        "<link name='d'><pose frame='__model__'>7 0 0 0 0 0</pose></link>"
    )
    world = load(model(f"<pose>10 0 0 0 0 0</pose>{links}"))
    assert in_world(world, "m::b")[:3, 3] == pytest.approx([11.0, 1.0, 0.0])
    assert in_world(world, "m::c")[:3, 3] == pytest.approx([11.0, 1.0, 3.0])
    assert in_world(world, "m::d")[:3, 3] == pytest.approx([17.0, 0.0, 0.0])


def test_the_pose_of_a_link_is_read_once_however_many_parts_it_has(load, monkeypatch):
    reads = []
    raw_pose = Element.raw_pose
    monkeypatch.setattr(Element, "raw_pose", lambda element: reads.append(element.tag) or raw_pose(element))

    def reads_of_links(parts):
        reads.clear()
        visuals = "".join(f"<visual name='v{number}'>{UNIT_BOX}</visual>" for number in range(parts))
        load(model(f"<link name='l'>{visuals}<collision name='c'>{UNIT_BOX}</collision></link>"))
        return reads.count("link")

    assert reads_of_links(20) == reads_of_links(1)


def test_a_joint_may_be_named_like_a_link_and_then_the_name_means_the_link(load):
    world = load(
        "<model name='m'><link name='body'/><link name='wheel'><pose>0 2 0 0 0 0</pose></link>"
        "<joint name='wheel' type='revolute'><pose>0 0 1 0 0 0</pose><parent>body</parent>"
        "<child>wheel</child><axis><xyz>0 1 0</xyz></axis></joint>"
        "<link name='hub'><pose relative_to='wheel'>1 0 0 0 0 0</pose></link></model>"
    )
    assert in_world(world, "m::wheel")[:3, 3] == pytest.approx([0.0, 2.0, 0.0])
    assert in_world(world, "m::hub")[:3, 3] == pytest.approx([1.0, 2.0, 0.0])
    assert world.joints[0].pose_in_child[:3, 3] == pytest.approx([0.0, 0.0, 1.0])


def test_models_stand_in_frames_of_the_world_and_of_each_other(load):
    lone = "<link name='l'/>"
    world = load(
        "<frame name='corner'><pose>0 5 0 0 0 0</pose></frame>"
        f"<model name='a'><static>1</static><pose relative_to='corner'>1 0 0 0 0 0</pose>{lone}</model>"
        f"<model name='b'><static>1</static><pose relative_to='a::l'>0 1 0 0 0 0</pose>{lone}</model>"
        "<model name='c' placement_frame='l'><static>1</static><pose>0 0 0 0 0 0</pose>"
        "<link name='l'><pose>3 0 0 0 0 0</pose></link><link name='k'/></model>"
    )
    assert in_world(world, "a::l")[:3, 3] == pytest.approx([1.0, 5.0, 0.0])
    assert in_world(world, "b::l")[:3, 3] == pytest.approx([1.0, 6.0, 0.0])
    assert in_world(world, "c::k")[:3, 3] == pytest.approx([-3.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("links", "reason"),
    [
        ("<link name='a'><pose relative_to='b'/></link>", "there is no frame 'b'"),
        (
            "<link name='a'><pose relative_to='b'/></link><link name='b'><pose relative_to='a'/></link>",
            "depends on itself",
        ),
    ],
)
def test_unknown_and_circular_frames_are_errors(load, links, reason):
    with pytest.raises(WorldError, match="link '[ab]'") as caught:
        load(model(links))
    assert reason in str(caught.value)


def test_the_scale_of_a_state_scales_the_shapes_of_a_model(load):
    world = load(
        geometry("<cylinder><radius>1</radius><length>1</length></cylinder>")
        + "<state world_name='w'><model name='m'><pose>1 0 0 0 0 0</pose><scale>2 3 4</scale></model></state>"
    )
    assert world.bodies[0].collisions[0].shape == Cylinder(3.0, 4.0)


POLYLINE = (
    "<polyline><point>0 0</point><point>2 0</point><point>2 1</point><point>1 1</point><point>1 2</point>"
)


@pytest.mark.parametrize(("height", "top"), [("", 1.0), ("<height>2.5</height>", 2.5)])
def test_polylines_are_extruded_to_walls(load, height, top):
    (body,) = load(geometry(f"{POLYLINE}<point>0 2</point>{height}</polyline>")).bodies
    mesh = body.collisions[0].shape
    assert mesh.vertices[:, 2].max() == top
    area = areas_of(mesh.vertices[mesh.triangles]).sum()
    assert area == pytest.approx(2.0 * 3.0 + 8.0 * top), "an L of 3 m^2 with an outline of 8 m"


def areas_of(triangles):
    sides = triangles[:, 1:] - triangles[:, :1]
    return np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2.0


def test_further_polylines_are_holes(load):
    square = "".join(f"<point>{x} {y}</point>" for x, y in ((-2, -2), (2, -2), (2, 2), (-2, 2)))
    hole = "".join(f"<point>{x} {y}</point>" for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    (body,) = load(geometry(f"<polyline>{square}</polyline><polyline>{hole}</polyline>")).bodies
    triangles = body.collisions[0].shape.vertices[body.collisions[0].shape.triangles]
    lid = triangles[(triangles[:, :, 2] == 1.0).all(axis=1)]
    assert areas_of(lid).sum() == pytest.approx(16.0 - 4.0)


def test_ignored_content_of_one_kind_gives_one_warning_with_its_count(load):
    sensor = "<link name='l'><sensor name='s' type='camera'/></link>"
    world = load(model(sensor, "a") + model(sensor, "b") + model("<gripper name='g'/>", "c"))
    assert len(world.warnings) == 2
    assert "test.world:1: sdf > world 'w' > model 'c' > gripper 'g': has no effect" in world.warnings[1]
    assert "sensor 's': has no effect (and 1 more like it)" in world.warnings[0]


def test_a_missing_mesh_gives_one_warning_and_is_an_error_if_strict(load):
    text = geometry("<mesh><uri>model://no/a.dae</uri></mesh>")
    assert len(load(text + text.replace("'m'", "'n'")).warnings) == 1
    for missing in (text, "<include><uri>model://unicorn</uri></include>"):
        with pytest.raises(WorldError, match=r"test\.world: .*not found"):
            load(missing, strict=True)


def test_a_missing_mesh_of_a_gazebo_model_is_replaced_by_its_footprint(load):
    dumpster = "<mesh><uri>model://dumpster/meshes/dumpster.dae</uri><scale>2 2 1</scale></mesh>"
    world = load(geometry(dumpster))
    vertices = world.bodies[0].collisions[0].shape.vertices
    assert vertices.max(axis=0) - vertices.min(axis=0) == pytest.approx([3.0, 1.92, 1.18])
    assert "dumpster.dae not found, only its footprint is used" in world.warnings[0]
    with pytest.raises(WorldError, match="not found"):
        load(geometry(dumpster), strict=True)


def test_a_footprint_may_have_parts(load):
    table = "<mesh><uri>model:///table_marble/meshes/table_lightmap.dae</uri></mesh>"
    legs = load(geometry(table)).bodies[0].collisions[0].shape
    triangles = legs.vertices[legs.triangles]
    lids = triangles[(triangles[:, :, 2] == 1.3).all(axis=1)]
    assert (np.abs(lids[:, :, 0]) > 3.0).all()
    assert areas_of(lids).sum() == pytest.approx(0.7 * 0.5 * 2 + 0.8 * 0.5 + 0.7 * 0.5)


def test_colours_come_from_the_material_or_its_script(load):
    def visual(material):
        return f"<visual name='v'>{UNIT_BOX}<material>{material}</material></visual>"

    world = load(
        model(f"<link name='l'>{visual('<diffuse>1 0.5 0 1</diffuse>')}</link>")
        + model(f"<link name='l'>{visual('<script><name>Gazebo/Blue</name></script>')}</link>", "n")
        + model(f"<link name='l'><visual name='v'>{UNIT_BOX}</visual></link>", "o")
    )
    assert [body.visuals[0].colour for body in world.bodies] == [(1.0, 0.5, 0.0), (0.0, 0.0, 1.0), None]


def test_emissive_colours_are_read(load):
    material = "<material><emissive>0.5 2 0 1</emissive></material>"
    world = load(model(f"<link name='l'><visual name='v'>{UNIT_BOX}{material}</visual></link>"))
    assert world.bodies[0].visuals[0].emissive == (0.5, 1.0, 0.0)


def test_inertia_is_turned_to_its_principal_axes(load):
    matrix = "<ixx>2</ixx><ixy>1</ixy><iyy>2</iyy><izz>5</izz>"
    inertial = f"<inertial><pose>0 0 1 0 0 0</pose><mass>3</mass><inertia>{matrix}</inertia></inertial>"
    (body,) = load(f"<model name='m'><link name='l'>{inertial}</link></model>").bodies
    axes = body.inertia.pose_in_body[:3, :3]
    assert axes @ np.diag(body.inertia.moments) @ axes.T == pytest.approx(
        np.array([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 5.0]])
    )
    assert body.inertia.pose_in_body[2, 3] == 1.0


@pytest.mark.parametrize("invalid", ["<ixx>0</ixx>", "<ixx>nan</ixx>", "<ixx>-1</ixx>"])
def test_moments_of_inertia_that_are_not_positive_are_ignored_with_a_warning(load, invalid):
    inertial = f"<inertial><mass>3</mass><inertia>{invalid}</inertia></inertial>"
    world = load(f"<model name='m'><link name='l'>{inertial}</link></model>")
    assert world.bodies[0].inertia.moments is None
    assert "link 'l' > inertial > inertia: ignored" in world.warnings[0]


def test_angles_of_a_pose_may_be_in_degrees_or_a_quaternion(load):
    half = math.sqrt(0.5)
    for pose in (
        "<pose degrees='true'>1 2 3 0 0 90</pose>",
        f"<pose rotation_format='quat_xyzw'>1 2 3 0 0 {half} {half}</pose>",
        "<pose rotation_format='euler_rpy' degrees='false'>1 2 3 0 0 1.5707963267948966</pose>",
    ):
        link = f"<link name='l'><collision name='c'>{UNIT_BOX}</collision></link>"
        (body,) = load(model(pose + link)).bodies
        assert body.pose_in_world == pytest.approx(pose3(1.0, 2.0, 3.0, yaw=math.pi / 2.0)), pose


@pytest.mark.parametrize(
    ("pose", "message"),
    [
        ("<pose rotation_format='axis'>1 2 3 0 0 0</pose>", "rotation_format must be euler_rpy or quat_xyzw"),
        ("<pose rotation_format='quat_xyzw'>1 2 3 0 0 0</pose>", "expected 7 finite numbers"),
        ("<pose rotation_format='quat_xyzw'>1 2 3 0 0 0 0</pose>", "the quaternion is zero"),
    ],
)
def test_a_rotation_that_is_not_valid_is_an_error(load, pose, message):
    with pytest.raises(WorldError, match=message):
        load(model(pose + "<link name='l'/>"))


def test_a_spawned_model_stands_where_its_own_pose_places_it_in_the_requests_frame(tmp_path):
    crate = f"<link name='l'><collision name='c'>{UNIT_BOX}</collision></link>"
    request = pose3(1.0, 2.0, 0.0, yaw=math.pi / 2.0)
    text = f"<sdf version='1.6'>{model('<pose>0.3 0 0.5 0 0 0</pose>' + crate)}</sdf>"
    (body,) = read_model(text, "mine", request).bodies
    assert body.pose_in_world == pytest.approx(pose3(1.0, 2.3, 0.5, yaw=math.pi / 2.0))
    assert body.pose_in_model == pytest.approx(np.eye(4))
    add_model(tmp_path, "crate", model("<pose>7 7 7 0 0 0</pose>" + crate))
    include = "<include><uri>model://crate</uri>{}</include>"
    for pose, z in (("<pose>0.3 0 0.5 0 0 0</pose>", 0.5), ("<pose>0.3 0 0 0 0 0</pose>", 0.0)):
        text = f"<sdf version='1.6'><world name='w'>{include.format(pose)}</world></sdf>"
        (body,) = read_model(text, "mine", request, [tmp_path]).bodies
        assert body.name == "mine::l"
        assert body.pose_in_world == pytest.approx(pose3(1.0, 2.3, z, yaw=math.pi / 2.0))
    text = f"<sdf version='1.6'><world name='w'>{include.format('')}</world></sdf>"
    (body,) = read_model(text, "mine", request, [tmp_path]).bodies
    assert body.pose_in_world == pytest.approx(request), "gazebo_ros gives an <include> the request's pose"
