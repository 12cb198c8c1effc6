"""Scenes are read by a child process: one result per request, whatever happens to the others."""

from pathlib import Path
from queue import Queue

import pytest

from cockpit.ros.world import scene_reader
from cockpit.ros.world.scene_reader import MODEL, ROBOT, WORLD, SceneReader, read_scenes
from cockpit.scene.description import SceneDescription

HOME = Path(__file__).resolve().parents[3] / "map/home.world"
SDF = """<sdf version="1.6"><model name="m"><link name="l">
<visual name="v"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></visual></link></model></sdf>"""
URDF = """<robot name="m"><link name="l"><inertial><mass value="1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.2 0.2 0.2"/></geometry></visual>
<collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link></robot>"""
ROBOT_TEXT = "<robot name='a'><link name='base'/></robot>"


def test_each_request_returns_a_scene_or_a_reason():
    world, robot, nonsense, missing = read_scenes(
        [
            (WORLD, str(HOME), ""),
            (ROBOT, "", ROBOT_TEXT),
            (ROBOT, "", "nonsense"),
            (WORLD, "/nowhere.world", ""),
        ]
    )
    assert isinstance(world, SceneDescription) and len(world.parts) > 10
    assert isinstance(robot, SceneDescription)
    assert "not well-formed" in nonsense
    assert missing.startswith("/nowhere.world: cannot be read")


def test_a_world_without_a_file_is_read_from_its_description(tmp_path):
    file, torn = tmp_path / "world.npz", tmp_path / "torn.npz"
    (world,) = read_scenes([(WORLD, str(HOME), "")])
    file.write_bytes(world.to_bytes())
    torn.write_bytes(world.to_bytes()[:1000])
    requests = [(WORLD, str(file), ""), (WORLD, str(torn), ""), (WORLD, "/nowhere.npz", "")]
    described, unusable, missing = read_scenes(requests)
    assert [part.link for part in described.parts] == [part.link for part in world.parts]
    assert unusable.startswith(f"{torn}: no description of a world")
    assert missing.startswith("/nowhere.npz: no description of a world")


def test_one_that_ends_the_process_leaves_the_others(monkeypatch):
    answered = []

    class Deadly(scene_reader.Popen):
        def communicate(self, asked, *rest):
            answered.append(asked)
            if b"deadly" in asked:
                self.kill()
            return super().communicate(asked, *rest)

    monkeypatch.setattr(scene_reader, "Popen", Deadly)
    deadly, robot = read_scenes([(ROBOT, "", "deadly"), (ROBOT, "", ROBOT_TEXT)])
    assert (deadly, type(robot)) == ("could not be read", SceneDescription)
    assert len(answered) == 3


def test_what_is_prepared_reads_what_comes_next_only():
    reader, answers = SceneReader(), Queue()
    reader.prepare()
    for _ in range(2):
        reader.read_in_background([(ROBOT, "", ROBOT_TEXT)], answers.put)
        (answer,) = answers.get(timeout=20.0)
        assert isinstance(answer, SceneDescription)


def test_a_prepared_process_that_is_not_needed_ends(monkeypatch):
    started = []
    start = scene_reader._start
    monkeypatch.setattr(scene_reader, "_start", lambda: started.append(start()) or started[-1])
    reader = SceneReader()
    reader.prepare()
    reader.stop()
    reader.stop()
    (process,) = started
    assert process.poll() is not None


def test_a_reading_that_takes_too_long_is_an_error(monkeypatch):
    monkeypatch.setattr(scene_reader, "READING_SECONDS", 0.001)
    assert read_scenes([(ROBOT, "", ROBOT_TEXT)]) == ["was not read within 0.001 s"]


def test_a_model_is_shown_under_the_name_that_it_was_spawned_by():
    for text in (SDF, URDF):
        (answer,) = read_scenes([(MODEL, "cup", text)])
        (piece,) = answer.parts
        assert (piece.model, piece.link) == ("cup", "l")
        assert abs(piece.vertices).max() == pytest.approx(0.1)
