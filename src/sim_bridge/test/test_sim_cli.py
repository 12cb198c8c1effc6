"""The command lines of sim_bridge."""

from pathlib import Path

import numpy as np
import pytest

from planar import load_map
from sim_bridge import load_world
from sim_bridge.description.urdf import read_urdf
from sim_bridge.ros.description import find_file, robot_description
from sim_bridge.ros.rendering import render_map
from sim_bridge.views.true_map import true_map

HOME = Path(__file__).resolve().parents[3] / "map" / "home.world"


def test_render_map_writes_the_true_map(monkeypatch, tmp_path):
    monkeypatch.setattr("sys.argv", ["render_map", str(HOME), str(tmp_path / "home"), "--resolution", "0.1"])
    render_map()
    expected = true_map(load_world(HOME), resolution=0.1)
    assert np.array_equal(load_map(tmp_path / "home.yaml").cells, expected.cells)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["/no.world", "stem"], "/no.world: cannot be read"),
        ([str(HOME), "/nowhere/stem"], "/nowhere/stem.pgm: cannot be written"),
        ([str(HOME), "stem", "--resolution", "0"], "--resolution must be positive"),
        ([str(HOME), "stem", "--height", "9"], "nothing is solid at a height of 9 m"),
    ],
)
def test_errors_of_render_map_name_the_cause(monkeypatch, capsys, arguments, named):
    monkeypatch.setattr("sys.argv", ["render_map", *arguments])
    with pytest.raises(SystemExit) as ended:
        render_map()
    assert ended.value.code == 2
    assert named in capsys.readouterr().err


def test_robot_description_prints_a_urdf(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["robot_description", "turtlebot_kinect"])
    robot_description()
    assert "camera_depth_frame" in capsys.readouterr().out


def test_a_description_with_prefixed_frames_is_the_same_robot(monkeypatch, capsys):
    described = []
    for frames in ([], ["--frames", "alice"]):
        monkeypatch.setattr("sys.argv", ["robot_description", "turtlebot_kinect", *frames])
        robot_description()
        described.append(capsys.readouterr().out)
    plain, framed = (read_urdf(text, "robot", find_file)[0] for text in described)
    assert list(framed.links) == [f"alice/{name}" for name in plain.links]
    assert [(name, joint.parent, joint.child) for name, joint in framed.joints.items()] == [
        (name, f"alice/{joint.parent}", f"alice/{joint.child}") for name, joint in plain.joints.items()
    ]
