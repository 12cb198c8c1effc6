import numpy as np
import pytest

from laboratory.suites import load_suites
from laboratory.worlds.barn import BarnFolder, reference_length, score
from planar import SettingsError

WORLD = """<sdf version="1.6"><world name="barn"><model name="ground"><static>true</static><link name="link">
<collision name="c"><geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>
</world></sdf>"""
SCENARIO = """\
world: {barn: worlds}
robot: {profile: jackal, start: {x: -2.25, y: 3.0, yaw: 1.57}}
task: {reach: {x: 10.0, y: 0.0}}
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "worlds").mkdir()
    for number in (7, 30):
        (tmp_path / f"worlds/world_{number}.world").write_text(WORLD)
        np.save(tmp_path / f"worlds/path_{number}.npy", np.array([[15, 0], [15, 30]]))
    (tmp_path / "barn.yaml").write_text(SCENARIO)
    return tmp_path


def test_seeds_use_the_worlds_in_turn(folder):
    source = BarnFolder(folder / "worlds")
    assert [source.arena(seed).title for seed in range(3)] == ["BARN 7", "BARN 30", "BARN 7"]


def test_a_barn_scenario_can_be_loaded(folder):
    scenarios, complaints = load_suites([str(folder / "barn.yaml")])
    assert complaints == [] and scenarios[0].task.files() == ()


def test_a_folder_without_worlds_is_named_with_its_line(tmp_path):
    path = tmp_path / "barn.yaml"
    path.write_text(SCENARIO)
    _, complaints = load_suites([str(path)])
    assert complaints[0].startswith(f"{path}:1: world.barn cannot be used: ")
    assert "world_N" in complaints[0]


NPZ = b"PK\x05\x06" + bytes(18)
HUGE = b"\x93NUMPY\x01\x00\x43\x00{'descr': '<f8', 'fortran_order': False, 'shape': (999999999999, 2)}\n"


@pytest.mark.parametrize("content", [b"", b"no array", b"\x93NUMPY\x01\x00\xff\xff{", NPZ, HUGE])
def test_a_broken_reference_path_is_named(folder, content):
    (folder / "worlds/path_7.npy").write_bytes(content)
    with pytest.raises(SettingsError, match=r"path_7\.npy: not a reference path"):
        BarnFolder(folder / "worlds").arena(0)


def test_files_without_a_number_are_ignored(folder):
    (folder / "worlds/world_x.world").write_text(WORLD)
    assert len(BarnFolder(folder / "worlds").pairs()) == 2


def test_the_score_is_at_best_a_half_and_falls_with_the_time_taken():
    path_length = reference_length(np.array([[15, 0], [15, 30]]))
    assert path_length == pytest.approx(10.0, abs=0.5)
    optimal = path_length / 2.0
    assert score(1.0, path_length) == score(2.0 * optimal, path_length) == 0.5
    assert score(4.0 * optimal, path_length) == 0.25
    assert score(1000.0, path_length) == 0.125
