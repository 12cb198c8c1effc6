"""The Mapper with faulty scans, odometry and clocks, saved and loaded in between, in any order."""

import math
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from planar import OCCUPIED, Pose2, Scan, grid_from_picture
from planar.errors import OutOfRangeError
from planar.geometry.ray_casting import cast_rays
from slam_lite.config import MapperSettings
from slam_lite.map_localizer import MapLocalizer
from slam_lite.mapper import Mapper
from slam_lite.rendering import SessionRenderer
from slam_lite.state import load_state, save_state

ROOM_PICTURE = """
####################
#......#...........#
#......#...........#
#..................#
#..............##..#
#..............##..#
####...............#
#..................#
#..........#.......#
####################
"""
ROOM = grid_from_picture(ROOM_PICTURE, 0.05, scale=4)
START = Pose2(1.0, 0.8, 0.3)
BEAMS, RANGE_MAX = 90, 5.0
SETTINGS = MapperSettings(keyframe_distance=0.1, still_interval=0.3)
# Largest map: scans reach 5 m, and trajectories that are farther apart are placed beside each other.
MOST_CELLS = 40_000_000


class MapperStateMachine(RuleBasedStateMachine):
    """The node's calls of a Mapper; ``keyframes``: their number so far."""

    @initialize()
    def begin(self):
        self.base_in_map, self.base_in_odom, self.now = START, Pose2(), 100.0
        self.mapper, self.keyframes = Mapper(SETTINGS, deferred=True), 0
        self.renderer = self.new_renderer()
        self.localizer = None

    def new_renderer(self):
        return SessionRenderer(SETTINGS.resolution, SETTINGS.occupied_threshold)

    def insert(self, ranges, stamp=None):
        stamp = self.now if stamp is None else stamp
        scan = Scan(stamp, -math.pi, 2.0 * math.pi / BEAMS, ranges.astype(np.float32), 0.1, RANGE_MAX)
        for localizer in filter(None, (self.mapper, self.localizer)):
            update = localizer.insert(self.base_in_odom, scan)
            if update is not None:
                assert update.base_in_map.is_finite()
                assert update.odom_in_map.is_finite()
                assert np.isfinite(update.information).all()
                assert 0.0 <= update.response <= 1.0
                assert update.odometry_chi_square >= 0.0

    def seen(self):
        angles = -math.pi + np.arange(BEAMS) * 2.0 * math.pi / BEAMS
        ranges = cast_rays(ROOM, self.base_in_map, angles, RANGE_MAX)
        return np.where(ranges >= RANGE_MAX, np.inf, ranges)

    @rule(count=st.sampled_from((1, 2, 5)), turn=st.sampled_from((0.3, -0.3)))
    def the_robot_drives(self, count, turn):
        for _ in range(count):
            ahead = self.base_in_map @ Pose2(0.25)
            step = Pose2(0.12 * (ROOM.value_at(ahead.x, ahead.y) == 0), 0.0, turn)
            self.base_in_map, self.base_in_odom = self.base_in_map @ step, self.base_in_odom @ step
            self.now += 0.3
            self.insert(self.seen())

    @rule(off=st.sampled_from((0.0, -2.0, -1e5, 7.0)))
    def a_scan_comes(self, off):
        self.insert(self.seen(), self.now + off)

    @rule(
        value=st.sampled_from((math.nan, math.inf, -math.inf, 0.0, -1.0, 0.1, 0.2, 4.99, 1e30)),
        count=st.sampled_from((0, 1, BEAMS, 400)),
        step=st.sampled_from((Pose2(), Pose2(0.2, 0.0, 0.1))),
    )
    def a_bad_scan_comes(self, value, count, step):
        self.now += 0.4
        self.base_in_map, self.base_in_odom = self.base_in_map, self.base_in_odom @ step
        self.insert(np.full(count, value))

    @rule(
        to=st.sampled_from((Pose2(), Pose2(7.0, -7.0, 3.0), Pose2(300.0, 0.0, 0.0), Pose2(-9e5, 9e5, 0.785)))
    )
    def odometry_jumps(self, to):
        self.base_in_odom = to

    @rule(to=st.sampled_from((Pose2(math.nan, 0.0, 0.0), Pose2(0.0, math.inf, 0.0), Pose2(1e7, 0.0, 0.0))))
    def odometry_out_of_range_is_refused(self, to):
        was, self.base_in_odom = self.base_in_odom, to
        with pytest.raises(OutOfRangeError):
            self.insert(self.seen())
        self.base_in_odom = was

    @rule()
    def the_robot_moves_while_odometry_stands(self):
        self.base_in_map = self.base_in_map @ Pose2(0.0, 0.0, 0.2)
        self.now += 0.5
        self.insert(self.seen())

    @rule()
    def the_robot_is_carried(self):
        self.base_in_map = Pose2(3.0, 0.5, -1.0) if self.base_in_map.x < 2.0 else START

    @rule(seconds=st.sampled_from((6.0, 1e6, -6.0, -1e6)))
    def the_clock_jumps(self, seconds):
        self.now += seconds

    @rule()
    def loops_are_closed(self):
        task = self.mapper.closure_task()
        if task is not None:
            self.mapper.apply_closures(task.run())

    @rule()
    def the_map_is_drawn(self):
        evidence = self.mapper.evidence()
        self.renderer.update(evidence)
        grid = self.renderer.grid()
        assert grid.cells.size <= MOST_CELLS
        assert set(np.unique(grid.cells)) <= {-1, 0, OCCUPIED}

    def saved(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "state.npz"
            save_state(self.mapper.state(), path)
            return load_state(path)

    @rule()
    def a_state_is_as_it_was_saved(self):
        state, again = self.mapper.state(), self.saved()
        assert np.array_equal(state.poses, again.poses)
        assert np.array_equal(state.sessions, again.sessions)
        assert state.base_in_map == again.base_in_map
        for name, array in vars(state.edges).items():
            assert np.array_equal(array, getattr(again.edges, name))
        for saved, read in zip((*state.clouds, *state.beams), (*again.clouds, *again.beams)):
            assert all(np.array_equal(array, getattr(read, name)) for name, array in vars(saved).items())

    @rule(place=st.sampled_from((None, START, Pose2(50.0, 50.0, 1.0))), follows=st.booleans())
    def a_state_is_loaded(self, place, follows):
        state = self.saved()
        mapper = Mapper(SETTINGS, deferred=True)
        try:
            mapper.resume(state, place)
        except OutOfRangeError:
            assert min(place.distance_to(Pose2.from_array(pose)) for pose in state.poses) > 100.0
            return
        self.mapper = mapper
        self.renderer = self.new_renderer()
        self.keyframes = len(self.mapper.keyframe_poses)
        assert self.keyframes > 0 or len(state.poses) == 0
        self.localizer = MapLocalizer(SETTINGS, state, place) if follows else None

    @precondition(lambda self: self.localizer is not None)
    @rule()
    def the_pose_is_set(self):
        self.localizer.set_pose(self.base_in_map)

    @invariant()
    def nothing_is_lost(self):
        keyframes = len(self.mapper.keyframe_poses)
        assert keyframes >= self.keyframes
        self.keyframes = keyframes
        evidence = self.mapper.evidence()
        assert len(evidence.beams) == len(evidence.poses) == keyframes
        assert 0 <= evidence.older <= keyframes

    @invariant()
    def poses_are_finite(self):
        assert np.isfinite(self.mapper.keyframe_poses).all()
        assert self.mapper.base_in_map.is_finite()

    def teardown(self):
        """After any history, the robot is tracked and the map contains its last scans."""
        if not hasattr(self, "mapper"):
            return
        self.the_robot_drives(1, 0.3)
        before, truth = self.mapper.base_in_map, self.base_in_map
        self.the_robot_drives(5, 0.3)
        moved, estimated = truth.inverse() @ self.base_in_map, before.inverse() @ self.mapper.base_in_map
        assert moved.distance_to(estimated) < 0.2
        self.the_map_is_drawn()
        self.a_state_is_as_it_was_saved()


MapperStateMachine.TestCase.settings = settings(
    max_examples=40, stateful_step_count=20, deadline=None, derandomize=True, database=None
)
TestMapperStateMachine = MapperStateMachine.TestCase
