"""What worlds look like, and where a mouse points."""

import math

import numpy as np

from cockpit.models.pointing import drag_yaw, floor_intersection
from cockpit.models.solids import ball, box, cylinder
from cockpit.scene.description import SceneDescription, VisualPart, cut_at, merged
from cockpit.scene.reader import describe_world


def wall(low, high, colour=(1, 2, 3)):
    vertices, triangles = box()
    pose = np.eye(4)
    pose[:3, 3] = 5.0, 0.0, (low + high) / 2.0
    return VisualPart("home", "wall", pose, vertices * (1.0, 1.0, high - low), triangles, colour)


def heights(piece):
    return piece.vertices[:, 2] + piece.pose[2, 3]


def test_what_is_higher_is_cut_off_and_what_is_all_above_goes():
    assert heights(cut_at(wall(0.0, 2.5), 1.2)).max() == 1.2
    assert heights(cut_at(wall(0.0, 1.0), 1.2)).max() == 1.0
    assert len(cut_at(wall(2.5, 2.6), 1.2).triangles) == 0


def test_parts_of_one_colour_become_one_mesh():
    surfaces = merged((wall(0.0, 1.0), wall(1.0, 2.0), wall(0.0, 1.0, (9, 9, 9))))
    assert [(len(vertices), len(triangles)) for vertices, triangles, _ in surfaces] == [(16, 24), (8, 12)]


def test_a_look_comes_through_to_another_process():
    look = SceneDescription.from_bytes(SceneDescription((wall(0.0, 1.0),), ("a warning",)).to_bytes())
    assert look.warnings == ("a warning",)
    assert look.parts[0].colour == (1, 2, 3)
    assert np.allclose(look.parts[0].pose, wall(0.0, 1.0).pose)


def test_solids_are_a_metre_across():
    for solid in (box, ball, cylinder):
        vertices, triangles = solid()
        assert np.allclose(vertices.max(axis=0) - vertices.min(axis=0), 1.0)
        assert triangles.max() < len(vertices)


def test_a_ray_meets_the_floor_below_and_nowhere_above():
    assert floor_intersection((0.0, 0.0, 2.0), (1.0, 0.5, 1.0)) == (2.0, 1.0)
    assert floor_intersection((0.0, 0.0, 2.0), (1.0, 0.0, 3.0)) is None
    assert floor_intersection((0.0, 0.0, 2.0), (1.0, 0.0, 2.0)) is None
    assert floor_intersection((0.0, 0.0, 2.0), (1.0, 0.0, math.nan)) is None


def test_a_click_without_a_drag_has_no_direction():
    assert drag_yaw((0.0, 0.0), (0.0, 1.0), 7.0) == math.pi / 2
    assert drag_yaw((0.0, 0.0), (0.05, 0.0), 7.0) == 7.0
    assert drag_yaw((0.0, 0.0), None, 7.0) == 7.0


def test_a_door_is_shut_at_the_limit_where_it_was_built_and_what_has_none_is_opened_a_little(tmp_path):
    world = tmp_path / "doors.world"
    joint = (
        "<joint name='{0}' type='{1}'><parent>{0}_a</parent><child>{0}_b</child>"
        "<axis><xyz>0 0 1</xyz>{2}</axis></joint>"
    )
    links = "<link name='{0}_a'/><link name='{0}_b'><inertial><mass>1</mass></inertial></link>"
    limited = "<limit><lower>-1.5</lower><upper>0</upper></limit>"
    content = "".join(
        links.format(name) + joint.format(name, kind, limit)
        for name, kind, limit in (("hinge", "revolute", limited), ("rail", "prismatic", ""))
    )
    world.write_text(f"<sdf version='1.6'><world name='w'><model name='m'>{content}</model></world></sdf>")
    look = SceneDescription.from_bytes(describe_world(world, ()).to_bytes())
    assert [(joint.model, joint.name, joint.opened(0.0), joint.opened(1.0)) for joint in look.joints] == [
        ("m", "hinge", 0.0, -1.5),
        ("m", "rail", 0.0, 0.5),
    ]
