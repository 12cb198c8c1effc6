"""The rules of SDF, one by one."""

import math
import time

import numpy as np
import pytest

from sim_bridge.errors import WorldError
from sim_bridge.pose3 import pose3
from sim_bridge.sdf import load_world, read_model
from sim_bridge.shapes import Box, Cylinder, Mesh, Plane, Sphere

UNIT_BOX = "<geometry><box><size>1 1 1</size></box></geometry>"


@pytest.fixture
def load(tmp_path):
    """Loads the text between <world> and </world>."""

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
        (model("<joint name='hinge' type='revolute'/>"), "joint 'hinge'"),
        ("<population name='crowd'/>", "population 'crowd'"),
    ],
)
def test_what_is_left_out_is_named_and_the_rest_loads(load, content, named):
    world = load(content + model(name="rest"))
    assert [body.name for body in world.bodies] == ["rest::l"]
    assert len(world.warnings) == 1
    assert named in world.warnings[0]


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (
            geometry("<box><size>1 0 1</size></box>"),
            "collision 'c' > geometry > box > size: must be positive",
        ),
        (geometry("<box><size>1 1</size></box>"), "expected 3 finite numbers, got '1 1'"),
        (geometry("<cylinder><radius>1</radius></cylinder>"), "<length> is missing"),
        (model("<pose>nan 0 0 0 0 0</pose>"), "model 'm' > pose: expected 6 finite numbers"),
        (model("<pose>a b c 0 0 0</pose>"), "model 'm' > pose: expected 6 numbers"),
        (geometry("<plane><normal>0 0 0</normal></plane>"), "normal"),
    ],
)
def test_senseless_values_are_errors_that_name_file_and_element(load, content, named):
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
def test_files_that_are_no_world_are_refused(tmp_path, text, reason):
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
