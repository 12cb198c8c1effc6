#!/usr/bin/env python3
"""Bags replayed offline, run by the node or played in a loop; and maps received by topic."""

import math
import re
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np
import rosgraph
import rospy
import rostest
from bad_scans import BROKEN, break_scans
from bag_environment import BagEnvironment
from rosgraph_msgs.msg import Log
from waiting import wait_until

from planar import FREE, UNKNOWN, OccupancyGrid, Pose2, save_map, wrap
from planar_ros.messages.conversion import OccupancyGridArrays, grid_to_msg
from sim_bridge import load_world
from sim_bridge.views.true_map import true_map

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "benchmarks"))

from helpers.bags import BASE_FRAME, write_bag  # noqa: E402
from helpers.drives import random_drive  # noqa: E402

NEAR, NEAR_ANGLE = 0.15, 0.1
SECONDS = 20.0


class AmclBagsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_amcl_bags")
        world = load_world(str(ROOT / "map" / "home.world"))
        cls.grid = true_map(world)
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        cls.observations = random_drive(world, cls.grid, 1, SECONDS)
        cls.bag = str(cls.folder / "drive.bag")
        write_bag(cls.bag, cls.observations)
        save_map(cls.grid, cls.folder / "home")
        cls.node = BagEnvironment("amcl_lite")
        cls.parameters = {"base_frame_id": BASE_FRAME, "seed": 3}

    @classmethod
    def tearDownClass(cls):
        cls.node.stop_node()
        cls.temporary.cleanup()

    def assert_near(self, found, truth):
        self.assertIsNotNone(found, "the node has published no pose")
        self.assertLess(found.distance_to(truth), NEAR, f"{found} is not near {truth}")
        self.assertLess(abs(wrap(found.yaw - truth.yaw)), NEAR_ANGLE, f"{found} is not near {truth}")

    def command(self, name, bag, *arguments):
        """Return the replay command and its trajectory file."""
        tum = self.folder / f"{name}.tum"
        config = self.folder / "amcl.yaml"
        config.write_text(f"base_frame_id: {BASE_FRAME}\n")
        command = ["rosrun", "amcl_lite", "amcl_lite_replay", str(bag), "--config", str(config)]
        command += ["--map", str(self.folder / "home.yaml"), "--trajectory", str(tum), *arguments]
        return command, tum

    def replay(self, name, *arguments):
        """Return the trajectory file's content and the command's output."""
        command, tum = self.command(name, self.bag, *arguments)
        printed = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout.decode()
        return tum.read_bytes(), printed

    def test_the_same_seed_and_bag_give_the_same_trajectory_byte_for_byte(self):
        for start in ((), ("--global",)):
            first, _ = self.replay("first", "--seed", "5", *start)
            second, _ = self.replay("second", "--seed", "5", *start)
            other, _ = self.replay("other", "--seed", "6", *start)
            self.assertEqual(first, second)
            self.assertNotEqual(first, other)

    def test_a_replay_writes_one_pose_per_scan_and_prints_its_errors(self):
        trajectory, printed = self.replay("errors")
        rows = np.array([line.split() for line in trajectory.decode().splitlines()], dtype=float)
        self.assertEqual(rows.shape, (len(self.observations), 8))
        rmse = float(re.search(r"position error: .* rmse ([\d.]+) m", printed).group(1))
        truth = np.array([(seen.base_in_map.x, seen.base_in_map.y) for seen in self.observations])
        errors = np.hypot(*(rows[:, 1:3] - truth).T)
        self.assertAlmostEqual(rmse, math.sqrt(np.mean(errors**2)), delta=1e-3)
        self.assertLess(rmse, NEAR)

    def test_invalid_scans_are_skipped_with_a_warning(self):
        """They once ended the program with a signal."""
        broken = self.folder / "broken.bag"
        break_scans(self.bag, broken)
        command, tum = self.command("broken", broken)
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        warning = f"{broken}: skipping a scan (a scan with invalid angle_increment nan)"
        self.assertIn(warning, done.stderr)
        self.assertEqual(len(tum.read_text().splitlines()), len(self.observations) - BROKEN)

    def test_an_unreadable_bag_or_map_is_reported_in_one_line(self):
        for bag, map_file in ((__file__, self.folder / "home.yaml"), (self.bag, self.folder / "none.yaml")):
            command = ["rosrun", "amcl_lite", "amcl_lite_replay", str(bag), "--map", str(map_file)]
            done = subprocess.run(command, capture_output=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr.decode(), r"^error: [^\n]+\n$")

    def test_the_node_runs_a_bag_and_logs_the_final_pose(self):
        bag = str(self.folder / "base_scan.bag")
        write_bag(bag, self.observations, scan_topic="base_scan")
        printed = self.node.run_node(self.grid, self.parameters, "--run-from-bag", bag)
        place = re.search(r"Final location (\S+), (\S+), (\S+) with stamp=(\S+)", printed)
        self.assertIsNotNone(place, printed)
        x, y, yaw, stamp = map(float, place.groups())
        seen = min(self.observations, key=lambda one: abs(one.scan.stamp - (stamp - 10.0)))
        self.assert_near(Pose2(x, y, yaw), seen.base_in_map)

    def test_the_node_does_not_subscribe_to_the_scans_that_it_plays(self):
        bag = str(self.folder / "base_scan.bag")
        write_bag(bag, self.observations, scan_topic="base_scan")
        parameters = {**self.parameters, "bag_scan_period": 0.05}
        running = threading.Thread(
            target=self.node.run_node, args=(self.grid, parameters, "--run-from-bag", bag)
        )
        running.start()
        master = rosgraph.Master(rospy.get_name())

        def nodes_at(topic):
            return [dict(table).get(topic, []) for table in master.getSystemState()[:2]]

        wait_until("scans", lambda: "/amcl" in nodes_at("/base_scan")[0])
        self.assertNotIn("/amcl", nodes_at("/base_scan")[1])
        running.join()

    def test_it_warns_when_no_scan_has_been_received_for_15_s(self):
        warnings = []

        def on_log(log):
            if "No laser scan received" in log.msg:
                warnings.append(log.msg)

        subscriber = rospy.Subscriber("/rosout", Log, on_log, queue_size=100)
        self.node.start_node(self.grid, self.parameters)
        self.node.play(self.bag)
        self.assertEqual(warnings, [])
        self.node.advance_clock(14.0)
        time.sleep(2.0)
        self.assertEqual(warnings, [])
        for count in (1, 2):
            self.node.advance_clock(16.0)
            wait_until("a warning", lambda: len(warnings) == count)  # noqa: B023
        self.assertIn("on the /scan topic", warnings[0])
        subscriber.unregister()

    def test_a_looped_bag_is_localized_again_from_its_start(self):
        self.node.start_node(self.grid, self.parameters)
        for _ in range(2):
            final = self.node.play(self.bag)
            self.assert_near(final.found, final.truth)

    def test_a_map_is_received_by_topic_and_one_without_free_cells_is_rejected(self):
        publisher = rospy.Publisher("map", OccupancyGridArrays, queue_size=1, latch=True)
        self.node.start_node(self.grid, {**self.parameters, "use_map_topic": True, "first_map_only": True})
        blank = OccupancyGrid(np.full((20, 20), UNKNOWN, dtype=np.int8), 0.05)
        room = OccupancyGrid(np.full((20, 20), FREE, dtype=np.int8), 0.05)
        for grid in (blank, self.grid, room):  # rejected, used, ignored
            while publisher.get_num_connections() == 0:
                time.sleep(0.1)
            publisher.publish(grid_to_msg(grid, rospy.Time(1), "map"))
            time.sleep(2.0)
        final = self.node.play(self.bag)
        self.assert_near(final.found, final.truth)
        publisher.unregister()


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "amcl_bags", AmclBagsTest)
