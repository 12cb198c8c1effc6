from dataclasses import replace

import numpy as np
import pytest

from planar import FileWriteError, Pose2, Scan
from planar.errors import OutOfRangeError
from slam_lite.mapper import Mapper
from slam_lite.state import StateFileError, load_state, save_state


@pytest.fixture(scope="module")
def state(office):
    mapper = Mapper()
    for observation in office.drive(laps=0.25):
        mapper.insert(observation.base_in_odom, observation.scan)
    return mapper.state()


@pytest.mark.parametrize("is_compressed", (True, False))
def test_a_saved_state_is_loaded_unchanged(state, tmp_path, is_compressed):
    save_state(state, tmp_path / "map.npz", is_compressed)
    back = load_state(tmp_path / "map.npz")
    assert np.array_equal(back.poses, state.poses)
    assert np.array_equal(back.edges.information, state.edges.information)
    assert back.base_in_map == state.base_in_map
    assert len(back.clouds) == len(state.clouds)
    assert np.array_equal(back.clouds[-1].normals_xy, state.clouds[-1].normals_xy)
    assert np.array_equal(back.beams[-1].ends_xy, state.beams[-1].ends_xy)


def test_an_empty_state_is_loaded_too(tmp_path):
    save_state(Mapper().state(), tmp_path / "map.npz")
    assert len(load_state(tmp_path / "map.npz").clouds) == 0


def test_an_empty_state_can_be_resumed(office):
    mapper, place = Mapper(), Pose2(2.0, 2.0)
    mapper.resume(Mapper().state())
    mapper.insert(place, office.scan(place))
    assert len(mapper.keyframe_poses) == 1


def test_sessions_without_returns_can_be_resumed():
    mapper = Mapper()
    blind = Scan(0.0, -1.0, 0.1, np.full(20, np.nan, dtype=np.float32), 0.1, 5.0)
    for _ in range(3):
        mapper.insert(Pose2(), blind)
        state = mapper.state()
        mapper = Mapper()
        mapper.resume(state, Pose2())
    assert len(mapper.keyframe_poses) == 1


def test_a_session_of_a_single_long_beam_can_be_resumed():
    mapper = Mapper()
    for ranges in ([np.nan], [4.9]):
        mapper.insert(Pose2(), Scan(0.0, -3.1, 0.1, np.array(ranges, dtype=np.float32), 0.1, 5.0))
        state = mapper.state()
        mapper = Mapper()
        mapper.resume(state, Pose2())
    mapper.resume(mapper.state(), Pose2())
    assert len(mapper.keyframe_poses) == 1


@pytest.mark.parametrize("place", [Pose2(9e5, 0.0), Pose2(2.0, -500.0), Pose2(np.nan, 2.0), Pose2(2e6, 2.0)])
def test_a_pose_far_from_the_map_is_refused_and_the_mapper_unchanged(state, place):
    mapper = Mapper()
    mapper.resume(state)
    with pytest.raises(OutOfRangeError):
        mapper.resume(state, place)
    assert np.array_equal(mapper.keyframe_poses, state.poses)


def test_a_map_at_the_limit_of_coordinates_stays_within_it_and_can_be_loaded(office, tmp_path):
    """Odometry starts from zero in each session, and so may lead beyond the limit."""
    scan, rim = office.scan(Pose2(2.0, 2.0)), Pose2(999_998.0, 0.0)
    mapper = Mapper()
    mapper.insert(rim, scan)
    state, mapper = mapper.state(), Mapper()
    mapper.resume(state, rim)
    blind = replace(scan, ranges=np.full(len(scan.ranges), np.nan, dtype=np.float32))
    refused = 0
    for step in range(8):
        try:
            mapper.insert(Pose2(0.9 * step), replace(blind, stamp=1.0 + step))
        except OutOfRangeError:
            refused += 1
    save_state(mapper.state(), tmp_path / "map.npz")
    assert load_state(tmp_path / "map.npz").base_in_map.x > rim.x
    assert refused == 5


def test_a_folder_that_is_not_there_is_an_error_and_the_old_file_stays(state, tmp_path):
    with pytest.raises(FileWriteError, match="cannot be written"):
        save_state(state, tmp_path / "nowhere" / "map.npz")


@pytest.mark.parametrize(
    "content, complaint",
    [(None, "no such"), (b"", "not a readable"), (b"PK\x03\x04broken", "not a readable")],
)
def test_other_files_are_refused(content, complaint, tmp_path):
    path = tmp_path / "map.npz"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(StateFileError, match=complaint):
        load_state(path)


def test_a_truncated_state_is_refused(state, tmp_path):
    path = tmp_path / "map.npz"
    save_state(state, path)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with pytest.raises(StateFileError, match="not a readable"):
        load_state(path)


def test_another_version_is_refused(state, tmp_path):
    path = tmp_path / "map.npz"
    save_state(state, path)
    with np.load(path) as file:
        table = dict(file)
    np.savez(path, **{**table, "version": 99})
    with pytest.raises(StateFileError, match="version 99"):
        load_state(path)


BROKEN = {
    "a pose that is not finite": lambda table: {"poses": np.full_like(table["poses"], np.nan)},
    "a pose beyond everything": lambda table: {"poses": np.full_like(table["poses"], 1e30)},
    "an edge to nowhere": lambda table: {"edge_nodes": table["edge_nodes"] + 10**6},
    "an edge from before the first": lambda table: {"edge_nodes": table["edge_nodes"] - 10**6},
    "points of three coordinates": lambda table: {"points_xy": np.zeros((4, 3), np.float32)},
    "counts that do not add up": lambda table: {"point_counts": table["point_counts"] + 1},
    "no counts": lambda table: {"point_counts": None},
    "texts": lambda table: {"marks": np.array(["x"])},
    "a version that is a list": lambda table: {"version": np.array([2, 2])},
    "information that is infinite": lambda table: {
        "edge_information": np.full_like(table["edge_information"], np.inf)
    },
}


@pytest.mark.parametrize("what", BROKEN)
def test_a_corrupt_state_is_refused(state, tmp_path, what):
    path = tmp_path / "map.npz"
    save_state(state, path)
    with np.load(path) as file:
        table = dict(file)
    changed = {**table, **BROKEN[what](table)}
    np.savez(path, **{name: array for name, array in changed.items() if array is not None})
    with pytest.raises(StateFileError, match="map.npz"):
        load_state(path)
