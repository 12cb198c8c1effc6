#!/usr/bin/env python3
"""map_server and map_saver of map_lite have the interface of map_server 1.17."""

import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import rosgraph
import rosnode
import rospy
import rostest
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import GetMap

from planar import UNKNOWN, Pose2, grid_from_picture, load_map, save_map
from planar_ros.calls.load_map import LoadMap, LoadMapResult
from planar_ros.messages.conversion import OccupancyGridArrays, grid_from_msg, grid_to_msg

HOME = grid_from_picture("####\n#..#\n#?.#\n####", resolution=0.5, origin=Pose2(-1.0, -2.0, 0.5))
OTHER = grid_from_picture("##\n#.", resolution=0.25)
START_SECONDS, END_SECONDS = 30.0, 60.0


def command(name, *arguments):
    return ["rosrun", "map_lite", name, *map(str, arguments)]


def outcome(name, *arguments):
    """Exit code and output of a run to its end."""
    run = subprocess.run(
        command(name, *arguments),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=END_SECONDS,
        check=False,
    )
    return run.returncode, run.stdout.decode()


class MapLiteTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_map_lite")

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, str(self.folder))
        self.yaml = save_map(HOME, self.folder / "home")

    def start(self, name, *arguments):
        process = subprocess.Popen(command(name, *arguments))
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        return process

    def assert_same(self, message, grid):
        received = grid_from_msg(message)
        self.assertEqual(received.cells.tolist(), grid.cells.tolist())
        self.assertAlmostEqual(received.resolution, grid.resolution, places=6)
        self.assertLess(received.origin.distance_to(grid.origin), 1e-6)
        self.assertAlmostEqual(received.origin.yaw, grid.origin.yaw, places=6)

    def test_a_map_is_latched_and_served(self):
        self.start("map_server", self.yaml, "_frame_id:=home")
        message = rospy.wait_for_message("map", OccupancyGrid, START_SECONDS)
        self.assert_same(message, HOME)
        self.assertEqual(message.header.frame_id, "home")
        self.assertGreater(message.info.map_load_time, rospy.Time(0))
        metadata = rospy.wait_for_message("map_metadata", MapMetaData, 5.0)
        self.assertEqual((metadata.width, metadata.height), (4, 4))
        rospy.wait_for_service("static_map", 5.0)
        self.assert_same(rospy.ServiceProxy("static_map", GetMap)().map, HOME)

    @unittest.skipIf(LoadMap is None, "this nav_msgs has no LoadMap")
    def test_change_map_returns_the_map_or_the_reason(self):
        self.start("map_server", self.yaml)
        rospy.wait_for_service("change_map", START_SECONDS)
        change_map = rospy.ServiceProxy("change_map", LoadMap)
        other = save_map(OTHER, self.folder / "other")
        response = change_map(f"file://{other}")
        self.assertEqual(response.result, LoadMapResult.SUCCESS)
        self.assert_same(response.map, OTHER)
        self.assert_same(rospy.wait_for_message("map", OccupancyGrid, 5.0), OTHER)

        nowhere = change_map(str(self.folder / "nowhere.yaml"))
        self.assertEqual(nowhere.result, LoadMapResult.MAP_DOES_NOT_EXIST)
        nobody = change_map("package://no_such_package/a.yaml")
        self.assertEqual(nobody.result, LoadMapResult.MAP_DOES_NOT_EXIST)
        (self.folder / "home.pgm").unlink()
        imageless = change_map(str(self.yaml))
        self.assertEqual(imageless.result, LoadMapResult.INVALID_MAP_DATA)
        self.yaml.write_text("image: home.pgm\n")
        incomplete = change_map(str(self.yaml))
        self.assertEqual(incomplete.result, LoadMapResult.INVALID_MAP_METADATA)
        self.assert_same(rospy.ServiceProxy("static_map", GetMap)().map, OTHER)

    def test_an_image_with_a_resolution_is_a_map_too(self):
        self.start("map_server", self.folder / "home.pgm", "0.5")
        message = rospy.wait_for_message("map", OccupancyGrid, START_SECONDS)
        self.assertEqual(grid_from_msg(message).cells.tolist(), HOME.cells.tolist())
        self.assertEqual(message.info.origin.position.x, 0.0)

    def test_a_bad_map_ends_the_server_at_once_naming_file_and_key(self):
        self.yaml.write_text(self.yaml.read_text().replace("resolution: ", "resolution: x"))
        code, output = outcome("map_server", self.yaml)
        self.assertEqual(code, 2)
        self.assertIn("home.yaml:2: resolution must be a number", output)
        self.assertNotIn("Traceback", output)

    def test_a_missing_map_ends_the_server_at_once(self):
        code, output = outcome("map_server", self.folder / "nowhere.yaml")
        self.assertEqual(code, 2)
        self.assertIn("nowhere.yaml: no such file", output)

    def test_a_saved_map_loads_again_wherever_its_files_are_moved(self):
        self.start("map_server", self.yaml)
        rospy.wait_for_message("map", OccupancyGrid, START_SECONDS)
        code, output = outcome("map_saver", "-f", self.folder / "saved")
        self.assertEqual(code, 0, output)
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        for ending in ("pgm", "yaml"):
            (self.folder / f"saved.{ending}").rename(elsewhere / f"saved.{ending}")
        self.assertEqual(load_map(elsewhere / "saved.yaml").cells.tolist(), HOME.cells.tolist())

    def test_the_saver_exits_if_no_map_arrives_in_time(self):
        code, output = outcome("map_saver", "-f", self.folder / "saved", "--timeout", 1, "map:=nobody")
        self.assertEqual(code, 1)
        self.assertIn("no map on /nobody within 1 s", output)
        self.assertFalse((self.folder / "saved.yaml").exists())

    def test_the_saver_refuses_an_unknown_map_unless_forced(self):
        unknown = grid_from_picture("??\n??")
        publisher = rospy.Publisher("blank", OccupancyGridArrays, queue_size=1, latch=True)
        publisher.publish(grid_to_msg(unknown, rospy.Time.now(), "map"))
        code, output = outcome("map_saver", "-f", self.folder / "saved", "map:=blank")
        self.assertEqual(code, 1)
        self.assertIn("nothing is known", output)
        code, output = outcome("map_saver", "-f", self.folder / "saved", "--force", "map:=blank")
        self.assertEqual(code, 0, output)
        self.assertTrue((load_map(self.folder / "saved.yaml").cells == UNKNOWN).all())

    def test_the_saver_reports_that_it_cannot_write(self):
        publisher = rospy.Publisher("room", OccupancyGridArrays, queue_size=1, latch=True)
        publisher.publish(grid_to_msg(HOME, rospy.Time.now(), "map"))
        code, output = outcome("map_saver", "-f", self.folder / "no/such/folder", "map:=room")
        self.assertEqual(code, 1)
        self.assertIn("cannot be written", output)

    def test_nodes_that_have_ended_are_unregistered(self):
        """Otherwise the next node of that name would shut down whatever listens on the old port by then."""
        server = self.start("map_server", self.yaml)
        rospy.wait_for_message("map", OccupancyGrid, START_SECONDS)
        code, output = outcome("map_saver", "-f", self.folder / "saved")
        self.assertEqual(code, 0, output)
        server.terminate()
        server.wait(END_SECONDS)
        master = rosgraph.Master("/test")
        for node in ("/map_server", "/map_saver"):
            self.assertIsNone(rosnode.get_api_uri(master, node), node)

    def test_wrong_thresholds_are_refused(self):
        for arguments in (("--occ", 20, "--free", 30), ("--occ", "many"), ("--occ", 101)):
            self.assertEqual(outcome("map_saver", *arguments)[0], 1, arguments)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "map_lite", MapLiteTest)
