#!/usr/bin/env python3
"""The cockpit with unauthorized requests, malformed messages from pages, and a malformed graph.

After each of them a valid page is served, the graph continues, and a robot driven by a page that is cut off
is commanded to stop.
"""

import contextlib
import http.client
import itertools
import math
import os
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from urllib.parse import urlsplit

import psutil
import rospy
import rostest
from geometry_msgs.msg import Point, Pose, PoseArray, TransformStamped, Twist
from nav_msgs.msg import OccupancyGrid
from page_client import CAMERA, PageClient
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64, String
from std_srvs.srv import Empty, EmptyResponse
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker
from waiting import wait_until
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from cockpit.process import FREE_PORT, CockpitProcess
from cockpit.ros.calls import ANSWER_SECONDS

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
FORWARD, VELOCITIES = "I  forward", "/cmd_vel"
HOLD_SECONDS, DRIVING = 0.1, 0.05
# From the last that a page sends: a key counts as held for 0.5 s, then the robot brakes.
STOP_SECONDS = 4.0
END_SECONDS = 60.0
CONNECTIONS = 1000
CLICKS = 40  # more than viser has threads for what controls call
# More than a socket keeps for who does not read: of BEAMS points each.
MANY_PICTURES, BEAMS = 60, 20_000
NAN = float("nan")
NONSENSE = {
    "garbage": b"\xff\x00garbage",
    "text": "text",
    "an unknown kind": {"type": "RunPython", "code": "1"},
    "10 MB": b"\x00" * 10_000_000,
    "NaN": {**CAMERA, "position": [NAN, 0.0, 0.0]},
    "infinity": {**CAMERA, "fov": math.inf},
    "a word for a number": {**CAMERA, "fov": "wide"},
    "a place with two numbers": {**CAMERA, "position": [0.0, 0.0]},
}
# What a browser asks when it opens a socket.
UPGRADE = {
    "Upgrade": "websocket",
    "Connection": "Upgrade",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "MDEyMzQ1Njc4OWFiY2RlZg==",
}
# A node that can be killed; it publishes a marker repeatedly.
MORTAL = """
import time

import rospy
from visualization_msgs.msg import Marker
rospy.init_node("mortal")
marker = Marker(ns="mortal", id={number}, type=Marker.CUBE)
marker.header.frame_id, marker.pose.orientation.w = "odom", 1.0
marker.scale.x = marker.scale.y = marker.scale.z = 0.2
publisher = rospy.Publisher("/mortal/markers", Marker, queue_size=1)
while not rospy.is_shutdown():
    publisher.publish(marker)
    time.sleep(0.1)
"""


class Odd(String):
    """Of a type that nobody has."""

    _type, _md5sum, _full_text = "nowhere_msgs/Odd", "0" * 32, "string data"


class Liar(String):
    """Claims to be a grid."""

    _type, _md5sum = OccupancyGrid._type, OccupancyGrid._md5sum


class CockpitHostileTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.cockpit = CockpitProcess(FREE_PORT, Path(cls.folder) / "cockpit.log", tool="topics")
        cls.sines, cls.velocities = [], []
        rospy.Subscriber("/sine", Float64, lambda message: cls.sines.append(message.data))
        rospy.Subscriber(VELOCITIES, Twist, cls.velocities.append)
        threading.Thread(target=publish_changing_topics, daemon=True).start()
        cls.good = PageClient(cls.cockpit.url)
        wait_until("a velocity topic", lambda: VELOCITIES in cls.good.options("Velocities to"), 60.0)

    @classmethod
    def tearDownClass(cls):
        cls.good.close()
        cls.cockpit.close()

    def tearDown(self):
        """Whatever was done: the page and the graph are alive, and nobody drives."""
        self.assertTrue(self.good.is_open)
        self.good.wait_for_pictures()
        with PageClient(self.cockpit.url) as newcomer:
            newcomer.wait_for_pictures(3)
        received = len(self.sines)
        wait_until("the graph to continue", lambda: len(self.sines) > received + 20)
        self.wait_until_commanded_to_stop()

    def test_requests_without_the_token_are_rejected(self):
        cookie, origin = self.cookie(), {"Origin": self.site()}
        for target, headers in (
            ("/", {}),
            ("/?token=wrong", {}),
            ("/", {"Cookie": f"{cookie['Cookie']}wrong"}),
            ("/", {**cookie, "Host": "evil.example"}),
            ("/", {**cookie, "Origin": "http://evil.example"}),
            ("/", {**UPGRADE, **origin}),
            (f"/?token={self.token()}", {**UPGRADE, **origin}),
            ("/", {**UPGRADE, **cookie}),
            ("/", {**UPGRADE, **cookie, "Origin": "http://evil.example"}),
            ("/", {**UPGRADE, **cookie, **origin, "Host": "evil.example"}),
        ):
            self.assertEqual(status_of(self.port(), target, headers), 403, (target, headers))
        self.assertEqual(status_of(self.port(), "/", cookie), 200)
        self.assertEqual(status_of(self.port(), "/", {**UPGRADE, **cookie, **origin}), 101)
        with self.assertRaises(InvalidHandshake):
            PageClient(self.cockpit.url, origin="http://evil.example")

    def test_nonsense_of_a_page_that_drives_is_its_end_and_the_robot_stops(self):
        for name, nonsense in NONSENSE.items():
            with self.subTest(name), PageClient(self.cockpit.url) as bad:
                self.drive(bad)
                with contextlib.suppress(ConnectionClosed):
                    bad.send(nonsense)
                bad.wait_until_closed()
                self.wait_until_commanded_to_stop()

    def test_a_flood_of_messages_is_the_end_of_the_page_that_sends_it(self):
        with PageClient(self.cockpit.url) as bad:
            self.drive(bad)
            with contextlib.suppress(ConnectionClosed):
                for _ in range(20_000):
                    bad.press(FORWARD)
            bad.wait_until_closed()
            self.wait_until_commanded_to_stop()

    def test_a_value_that_a_control_cannot_have_reaches_nothing(self):
        with PageClient(self.cockpit.url) as bad:
            bad.set("Velocities to", "/other/cmd_vel")
            bad.set("Cut at (m)", "nan")
            self.drive(bad)
        self.assertNotIn("/other/cmd_vel", dict(rospy.get_published_topics()))

    def test_a_thousand_connections_leave_who_drives_in_command(self):
        with contextlib.ExitStack() as stack, PageClient(self.cockpit.url) as driver:
            for number in range(CONNECTIONS):
                opened = stack.enter_context(
                    socket.create_connection(("127.0.0.1", self.port()), END_SECONDS)
                )
                if number % 2:
                    opened.sendall(b"GET / HTTP/1.1\r\nHost: 127")  # and no more of it
            self.drive(driver)
            self.wait_until_commanded_to_stop()
            self.drive(driver)
            driver.close()
            self.wait_until_commanded_to_stop()
            self.good.wait_for_pictures()

    def test_a_page_that_reads_nothing_slows_nobody(self):
        head = {
            "Host": urlsplit(self.site()).netloc,
            "Origin": self.site(),
            "Sec-WebSocket-Protocol": self.good.protocol,
            **UPGRADE,
            **self.cookie(),
        }
        words = "".join(f"{name}: {value}\r\n" for name, value in head.items())
        with socket.socket() as deaf:
            deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            deaf.connect(("127.0.0.1", self.port()))
            deaf.sendall(f"GET / HTTP/1.1\r\n{words}\r\n".encode())
            began = time.monotonic()
            self.good.wait_for_pictures(MANY_PICTURES)
            self.assertLess(time.monotonic() - began, 0.3 * MANY_PICTURES)

    def test_malformed_messages_are_reported_and_the_others_are_shown(self):
        for topic, message, why in (
            ("/map", grid(2, 2, [0, 0, 0]), "a grid of 2 x 2 with 3 cells"),
            ("/far/map", grid(1, 1, [0], NAN), "the grid's origin is not finite"),
            ("/lied/map", Liar("no grid at all"), "not a nav_msgs/OccupancyGrid"),
            ("/bad/markers", marker(1, NAN), "is not finite"),
        ):
            publisher = rospy.Publisher(topic, type(message), queue_size=1, latch=True)
            publisher.publish(message)
            self.good.wait_for_notification(f"{topic}: ")
            self.good.wait_for_notification(why)
            if topic == "/bad/markers":
                publisher.publish(marker(2, 1.0))
                wait_until(
                    "the other marker",
                    lambda: any("bad:markers/hostile:2" in one for one in self.good.nodes),
                )
            publisher.unregister()

    def test_a_transform_and_particles_of_nan_harm_nobody(self):
        frame = TransformStamped(child_frame_id="nowhere")
        frame.header.frame_id = "odom"
        frame.transform.translation.x = NAN
        particles = PoseArray(poses=[frame_pose(NAN), frame_pose(1.0)])
        particles.header.frame_id = "odom"
        frames = rospy.Publisher("/tf", TFMessage, queue_size=1)
        cloud = rospy.Publisher("/particlecloud", PoseArray, queue_size=1, latch=True)
        cloud.publish(particles)
        shelf = TransformStamped(child_frame_id="shelf")
        shelf.header.frame_id, shelf.transform.rotation.w = "odom", 1.0
        still = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        still.publish(TFMessage([shelf]))

        def knows_the_shelf():
            frames.publish(TFMessage([frame]))
            time.sleep(0.02)
            return "shelf" in self.good.options("Fixed frame")

        wait_until("the valid topic beside it", knows_the_shelf)
        self.good.wait_for_text("publishes an invalid transform of nowhere")
        wait_until("the particles", lambda: any("particlecloud" in one for one in self.good.nodes))
        for publisher in (frames, cloud, still):
            publisher.unregister()

    def test_a_node_that_does_not_answer_is_waited_for_no_longer_than_some_seconds(self):
        over = threading.Event()
        self.addCleanup(over.set)
        rospy.Service("/gazebo/pause_physics", Empty, lambda _: over.wait() and EmptyResponse())
        with PageClient(self.cockpit.url) as driver:
            for _ in range(CLICKS):
                driver.set("Pause", True)
            began = time.monotonic()
            self.drive(driver)
            self.assertLess(time.monotonic() - began, ANSWER_SECONDS)
        self.good.wait_for_notification("no answer of the service /gazebo/pause_physics")

    def test_a_topic_of_an_unknown_type_is_listed_and_watching_it_shows_the_reason(self):
        publisher = rospy.Publisher("/odd", Odd, queue_size=1, latch=True)
        publisher.publish(Odd("words"))
        self.good.wait_for_text("nowhere_msgs/Odd")
        self.good.set("Watch", "/odd")
        self.good.wait_for_text("is not installed")
        self.good.set("Watch", "(none)")
        publisher.unregister()

    def test_a_node_that_dies_while_it_is_shown_may_come_back(self):
        for number in (1, 2):
            node = subprocess.Popen([sys.executable, "-c", MORTAL.format(number=number)])
            try:
                wait_until(
                    "its marker",
                    lambda number=number: any(f"mortal:{number}" in one for one in self.good.nodes),
                    END_SECONDS,
                )
            finally:
                node.kill()
                node.wait()
            self.good.wait_for_pictures(30)

    def test_it_listens_on_the_loopback_alone(self):
        (process,) = [one for one in psutil.Process().children() if "cockpit.ros.node" in one.cmdline()]
        listening = [found for found in process.net_connections("inet") if found.status == psutil.CONN_LISTEN]
        self.assertIn(self.port(), [found.laddr.port for found in listening])
        self.assertEqual({found.laddr.ip for found in listening}, {"127.0.0.1"})

    def test_what_cannot_be_served_or_played_is_one_sentence(self):
        folder = Path(self.folder)
        (folder / "garbage.bag").write_bytes(os.urandom(10_000))
        (folder / "cut.bag").write_bytes(b"#ROSBAG V2.0\n" + b"\x45\x00\x00\x00op")
        (folder / "empty").mkdir()
        (folder / "run" / "bag").mkdir(parents=True)
        (folder / "run" / "result.json").write_text("{" * 5000)
        (folder / "run" / "bag" / "run.bag").write_text("no bag")
        for words, why in (
            (("--web-port", str(self.port())), f"127.0.0.1:{self.port()} cannot be served"),
            (("--web-port", "70000"), "'70000' is not valid"),
            (("--tool", "hammer"), "unknown tool 'hammer'"),
            ((str(folder / "garbage.bag"),), "garbage.bag"),
            ((str(folder / "cut.bag"),), "cut.bag"),
            ((str(folder / "empty"),), "empty"),
            ((str(folder / "run"),), "run.bag"),
        ):
            done = subprocess.run(
                [str(SCRIPTS / "cockpit.sh"), *words], capture_output=True, text=True, timeout=END_SECONDS
            )
            self.assertEqual((words, done.returncode), (words, 2), done.stderr)
            self.assertIn(why, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)

    def drive(self, page):
        """Until the robot moves."""

        def moves():
            page.press(FORWARD)
            time.sleep(HOLD_SECONDS)
            return self.velocities and self.velocities[-1].linear.x > DRIVING

        wait_until("the robot to drive", moves)

    def wait_until_commanded_to_stop(self):
        at_rest = Twist()
        wait_until("a stop", lambda: not self.velocities or self.velocities[-1] == at_rest, STOP_SECONDS)

    def site(self):
        return self.cockpit.url.partition("/?")[0]

    def port(self):
        return urlsplit(self.cockpit.url).port

    def token(self):
        return self.cockpit.url.partition("token=")[2]

    def cookie(self):
        return {"Cookie": f"cockpit_{self.port()}={self.token()}"}


def status_of(port, target, headers):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=END_SECONDS)
    with contextlib.closing(connection):
        connection.request("GET", target, headers=headers)
        return connection.getresponse().status


def publish_changing_topics():
    """A scan that is another each time, so that there is always something to show."""
    publisher = rospy.Publisher("/scan", LaserScan, queue_size=1)
    for turn in itertools.count():
        if rospy.is_shutdown():
            return
        ranges = [1.0 + 0.01 * (turn % 100)] * BEAMS
        scan = LaserScan(angle_increment=2.0 * math.pi / BEAMS, range_max=10.0, ranges=ranges)
        scan.header.frame_id = "base_link"
        publisher.publish(scan)
        time.sleep(0.05)


def grid(width, height, cells, resolution=0.5):
    message = OccupancyGrid(data=cells)
    message.header.frame_id = "odom"
    message.info.width, message.info.height, message.info.resolution = width, height, resolution
    message.info.origin.orientation.w = 1.0
    return message


def marker(number, x):
    message = Marker(ns="hostile", id=number, type=Marker.SPHERE_LIST, points=[Point(x=x)])
    message.header.frame_id, message.pose.orientation.w = "odom", 1.0
    message.scale.x = message.scale.y = message.scale.z = 0.1
    return message


def frame_pose(x):
    pose = Pose()
    pose.position.x, pose.orientation.w = x, 1.0
    return pose


if __name__ == "__main__":
    rospy.init_node("test_cockpit_hostile")
    rostest.rosrun("home_service_tests", "hostile", CockpitHostileTest)
