"""Mesh files and the cache of converted meshes."""

import numpy as np
import pytest

from sim_bridge.errors import WorldError
from sim_bridge.geometry.meshes import load_mesh
from sim_bridge.geometry.shapes import MeshFile

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"
COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>{up}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 100 0 0 0 0 200</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


@pytest.fixture
def cache(tmp_path):
    return tmp_path / "cache"


@pytest.mark.parametrize("up", ["Z_UP", "Y_UP"])
def test_the_unit_of_collada_counts_and_like_in_gazebo_its_up_axis_does_not(tmp_path, cache, up):
    path = tmp_path / "a.dae"
    path.write_text(COLLADA.format(up=up))
    assert load_mesh(MeshFile(path), cache).vertices.max(axis=0) == pytest.approx([1.0, 0.0, 2.0])


def test_stl_and_obj_of_the_same_body_are_the_same(tmp_path, cache):
    import trimesh

    (tmp_path / "a.obj").write_text(TETRAHEDRON)
    trimesh.load(str(tmp_path / "a.obj")).export(str(tmp_path / "a.stl"))
    obj, stl = (load_mesh(MeshFile(tmp_path / f"a.{kind}"), cache) for kind in ("obj", "stl"))
    assert np.unique(obj.vertices, axis=0) == pytest.approx(np.unique(stl.vertices, axis=0))
    assert len(obj.triangles) == len(stl.triangles) == 4


def test_a_converted_mesh_is_taken_from_the_cache_until_its_file_changes(tmp_path, cache, monkeypatch):
    path = tmp_path / "a.obj"
    path.write_text(TETRAHEDRON)
    first = load_mesh(MeshFile(path, (2.0, 2.0, 2.0)), cache)
    (cached,) = cache.iterdir()
    monkeypatch.setattr("sim_bridge.geometry.meshes._convert", lambda file: pytest.fail("converted again"))
    again = load_mesh(MeshFile(path, (2.0, 2.0, 2.0)), cache)
    assert np.array_equal(first.vertices, again.vertices)
    assert load_mesh(MeshFile(path), cache).vertices.max() == 1.0, "the scale is not cached"
    monkeypatch.undo()
    path.write_text(TETRAHEDRON.replace("v 1 0 0", "v 3 0 0"))
    assert load_mesh(MeshFile(path), cache).vertices.max() == 3.0


@pytest.mark.parametrize("content", [b"", b"not a zip file", b"PK\x03\x04 cut off"])
def test_a_damaged_cache_file_is_replaced(tmp_path, cache, content):
    path = tmp_path / "a.obj"
    path.write_text(TETRAHEDRON)
    load_mesh(MeshFile(path), cache)
    (cached,) = cache.iterdir()
    cached.write_bytes(content)
    assert len(load_mesh(MeshFile(path), cache).triangles) == 4


def test_meshes_are_read_where_no_cache_can_be_written(tmp_path):
    (tmp_path / "a.obj").write_text(TETRAHEDRON)
    (tmp_path / "file").write_text("")
    assert len(load_mesh(MeshFile(tmp_path / "a.obj"), tmp_path / "file" / "cache").triangles) == 4


@pytest.mark.parametrize("keyword", ["o", "g"])
def test_a_part_of_an_obj_file_is_found_by_its_name(tmp_path, cache, keyword):
    low, high = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "v 0 0 5\nv 1 0 5\nv 0 1 5\nf 4 5 6\n"
    (tmp_path / "a.obj").write_text(f"{keyword} low\n{low}{keyword} high\n{high}")
    assert load_mesh(MeshFile(tmp_path / "a.obj", submesh="high"), cache).vertices[:, 2].min() == 5.0
    centred = load_mesh(MeshFile(tmp_path / "a.obj", submesh="high", centred=True), cache)
    assert centred.vertices.min(axis=0) == pytest.approx([-0.5, -0.5, 0.0])
    with pytest.raises(WorldError, match="holds no mesh named 'middle'"):
        load_mesh(MeshFile(tmp_path / "a.obj", submesh="middle"), cache)


@pytest.mark.parametrize(("name", "content"), [("a.obj", ""), ("a.dae", "<COLLADA"), ("a.xyz", "?")])
def test_a_file_without_a_mesh_is_an_error_that_names_it(tmp_path, cache, name, content):
    (tmp_path / name).write_text(content)
    with pytest.raises(WorldError, match=name):
        load_mesh(MeshFile(tmp_path / name), cache)
