"""Malicious world, robot and mesh files are refused with a clear error."""

import os

import numpy as np
import pytest

from sim_bridge.description import read_urdf_robot
from sim_bridge.errors import RobotError, WorldError
from sim_bridge.geometry.meshes import load_mesh
from sim_bridge.geometry.shapes import MeshFile
from sim_bridge.sdf import load_world

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"
LINKS = "".join(
    f'<link name="{name}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>'
    for name in "abc"
)


def world_with(tmp_path, geometry, version="1.6", pose="0 0 0 0 0 0"):
    path = tmp_path / "test.world"
    path.write_text(
        f'<sdf version="{version}"><world name="w"><model name="m"><static>1</static><pose>{pose}</pose>'
        f'<link name="l"><collision name="c"><geometry>{geometry}</geometry></collision></link>'
        "</model></world></sdf>"
    )
    return path


BOX = "<box><size>1 1 1</size></box>"


def test_a_version_with_thousands_of_digits_is_accepted(tmp_path):
    assert load_world(world_with(tmp_path, BOX, version="1." + 5000 * "6")).bodies


@pytest.mark.parametrize("pose", ["1e308 0 0 0 0 0", "0 0 1e30 0 0 0", "0 0 0 0 0 1e300"])
def test_a_model_with_coordinates_out_of_range_is_refused(tmp_path, pose):
    with pytest.raises(WorldError, match="coordinates must be within|finite"):
        load_world(world_with(tmp_path, BOX, pose=pose))


def test_a_box_beyond_the_size_limit_is_refused(tmp_path):
    with pytest.raises(WorldError, match="must be at most"):
        load_world(world_with(tmp_path, "<box><size>1e30 1 1</size></box>"))


@pytest.mark.parametrize(
    "uri", ["x" * 300 + ".obj", "file:///dev/zero", "model://../../etc/passwd", "//[a.obj"]
)
def test_a_mesh_uri_that_names_no_regular_file_is_ignored_or_refused(tmp_path, uri):
    try:
        world = load_world(world_with(tmp_path, f"<mesh><uri>{uri}</uri></mesh>"), [tmp_path])
    except WorldError as error:
        assert "not a regular file" in str(error)
    else:
        assert any("not found" in warning for warning in world.warnings)


def test_a_mesh_that_is_a_named_pipe_is_refused_at_once(tmp_path):
    os.mkfifo(str(tmp_path / "pipe.obj"))
    with pytest.raises(WorldError, match="not a regular file"):
        load_mesh(MeshFile(tmp_path / "pipe.obj"), tmp_path)


@pytest.mark.parametrize("content", ["v 0 0 0\nv 1 0 0\n", "l 1 2\nv 0 0 0\nv 1 1 1\n", ""])
def test_a_mesh_without_faces_is_refused(tmp_path, content):
    (tmp_path / "a.obj").write_text(content)
    with pytest.raises(WorldError, match="a.obj"):
        load_mesh(MeshFile(tmp_path / "a.obj"), tmp_path / "cache")


def test_a_mesh_scaled_beyond_the_size_limit_is_refused(tmp_path):
    (tmp_path / "a.obj").write_text(TETRAHEDRON)
    with pytest.raises(WorldError, match="exceeds 1e"):
        load_mesh(MeshFile(tmp_path / "a.obj", (1e300, 1.0, 1.0)), tmp_path / "cache")


@pytest.mark.parametrize(
    "broken",
    [
        {"triangles": np.array([[0, 1, 99]], np.int32)},
        {"vertices": np.full((4, 3), np.nan)},
        {"vertices": np.zeros(7)},
        {"colours": np.zeros((1, 3), np.float32)},
        {"triangles": np.zeros((4, 3))},
    ],
)
def test_a_corrupt_mesh_in_the_cache_is_converted_again(tmp_path, broken):
    (tmp_path / "a.obj").write_text(TETRAHEDRON)
    cache = tmp_path / "cache"
    whole = load_mesh(MeshFile(tmp_path / "a.obj"), cache)
    (cached,) = cache.glob("*.npz")
    with np.load(cached) as file:
        arrays = dict(file)
    np.savez(cached, **{**arrays, **broken})
    for _ in range(2):
        again = load_mesh(MeshFile(tmp_path / "a.obj"), cache)
        assert np.array_equal(again.triangles, whole.triangles)
    with np.load(cached) as file:
        assert np.array_equal(file["triangles"], arrays["triangles"])


def joint(name, parent, child):
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="fixed">{ends}</joint>'


@pytest.mark.parametrize(
    "joints",
    [
        joint("j1", "b", "c") + joint("j2", "c", "b"),
        joint("j0", "a", "b") + joint("j1", "b", "c") + joint("j2", "c", "b"),
        joint("j0", "b", "b") + joint("j1", "a", "c"),
    ],
)
def test_joints_that_form_a_loop_are_refused(joints):
    """Regression: the simulator followed them endlessly."""
    with pytest.raises(RobotError, match="form a loop: j"):
        read_urdf_robot(f'<robot name="r">{LINKS}{joints}</robot>', "r")


def test_a_link_with_coordinates_out_of_range_is_refused():
    far = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/><origin xyz="1e308 0 0"/></joint>'
    with pytest.raises(RobotError, match="coordinates must be within|finite"):
        read_urdf_robot(f'<robot name="r">{LINKS}{far}{joint("k", "a", "c")}</robot>', "r")


@pytest.mark.parametrize("width", ["1.5", "0", "-3", "1e9", "nan"])
def test_a_camera_needs_a_whole_number_of_pixels(width):
    camera = (
        '<gazebo reference="a"><sensor type="camera" name="c"><camera><image>'
        f"<width>{width}</width></image></camera>"
        '<plugin name="p" filename="libgazebo_ros_camera.so"/></sensor></gazebo>'
    )
    chain = joint("j", "a", "b") + joint("k", "a", "c")
    drive = '<gazebo><plugin name="d" filename="libgazebo_ros_planar_move.so"/></gazebo>'
    with pytest.raises(RobotError, match="whole number|finite"):
        read_urdf_robot(f'<robot name="r">{LINKS}{chain}{drive}{camera}</robot>', "r")
