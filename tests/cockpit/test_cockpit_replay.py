#!/usr/bin/env python3
"""A recording in the browser: played, paused, and looked at from any place of it."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import rosbag
import rospy
import rostest
from browser import Browser
from command import Command
from geometry_msgs.msg import PoseStamped, TransformStamped
from nav_msgs.msg import Path as PathMsg
from rosgraph_msgs.msg import Clock, Log
from std_msgs.msg import Float64
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker
from waiting import wait_until

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
PICTURES = os.environ.get("COCKPIT_PICTURES")
START, SECONDS, END_SECONDS = 100.0, 60, 40.0
LOG_TEXT = "two thirds of the way"


class CockpitReplayTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_recording_is_looked_at_from_any_place(self):
        record(self.folder / "drive.bag")
        bag, runs = self.folder / "drive.bag", self.folder / "runs"
        with Command(SCRIPTS / "cockpit.sh", bag, "--output", runs) as showing, Browser() as browser:
            os.environ["ROS_MASTER_URI"] = showing.wait_for_line("ROS_MASTER_URI=")
            rospy.init_node("looker_on", disable_signals=True)
            page = browser.open(showing.url, 1400, 900)
            page.wait_for("Replay", "playing", seconds=60.0)
            page.click("Pause")
            page.wait_for("paused")
            at = {name: Newest(name, kind) for name, kind in (("/number", Float64), ("/clock", Clock))}
            for wanted in (45, 12):
                page.fill_in("Time, s", str(wanted))
                page.wait_for(f"paused: {wanted}.0 s of 59.9 s")
                wait_until(f"the number of second {wanted}", lambda: at["/number"].newest.data == wanted)  # noqa: B023
                wait_until("its time", lambda: abs(at["/clock"].newest.clock.to_sec() - START - wanted) < 0.1)  # noqa: B023
                if PICTURES:
                    page.screenshot(Path(PICTURES) / f"replay_{wanted}.png")
            logged_before = times_logged(showing)
            page.choose("Speed", "20 x")
            page.click("Resume")
            page.wait_for("59.9 s of 59.9 s", seconds=30.0)
            wait_until("the log message", lambda: times_logged(showing) > logged_before)
            self.assertEqual(times_logged(showing), logged_before + 1)
            page.choose("Speed", "1 x")  # slow enough to be looked at before it ends again
            page.fill_in("Time, s", "30")
            wait_until("a number after the end", lambda: 30 <= at["/number"].newest.data < 59)
            self.assertEqual(page.errors, [])

    def test_a_file_that_is_no_recording_is_an_error_before_anything_starts(self):
        (self.folder / "broken.bag").write_text("no bag")
        for name, why in (("broken.bag", "not a readable bag"), ("none.bag", "no such bag")):
            command = [str(SCRIPTS / "cockpit.sh"), str(self.folder / name)]
            done = subprocess.run(command, capture_output=True, text=True, timeout=END_SECONDS)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn(f"{name}: {why}", done.stderr)


class Newest:
    """The newest message of a topic."""

    def __init__(self, topic, kind):
        self.newest = kind()
        rospy.Subscriber(topic, kind, lambda message: setattr(self, "newest", message))


def times_logged(showing):
    return sum(f"pick_objects: {LOG_TEXT}" in line for line in list(showing.lines))


def record(path):
    """A robot that drives along x, 1 m/s, with a number for each second and a marker for each ten.

    The log message at second 40 was recorded on /rosout and on /rosout_agg.
    """
    with rosbag.Bag(str(path), "w") as bag:
        for tick in range(10 * SECONDS):
            now = rospy.Time.from_sec(START + 0.1 * tick)
            odom = TransformStamped(child_frame_id="base_link")
            odom.header.frame_id, odom.header.stamp = "map", now
            odom.transform.translation.x, odom.transform.rotation.w = 0.1 * tick, 1.0
            bag.write("/tf", TFMessage([odom]), now)
            if tick % 10 == 0:
                bag.write("/number", Float64(tick // 10), now)
            if tick % 100 == 0:
                bag.write("/markers", cube(tick // 10, now), now)
            if tick == 300:
                bag.write("/plan", plan(now), now)
            if tick == 400:
                for topic in ("/rosout", "/rosout_agg"):
                    bag.write(topic, Log(name="/pick_objects", level=Log.INFO, msg=LOG_TEXT), now)


def cube(number, now):
    marker = Marker(id=number, type=Marker.CUBE)
    marker.header.frame_id, marker.header.stamp = "map", now
    marker.pose.position.x, marker.pose.orientation.w = float(number), 1.0
    marker.scale.x = marker.scale.y = marker.scale.z = 0.5
    marker.color.g = marker.color.a = 1.0
    return marker


def plan(now):
    path = PathMsg()
    path.header.frame_id, path.header.stamp = "map", now
    for metres in range(SECONDS):
        pose = PoseStamped(header=path.header)
        pose.pose.position.x, pose.pose.orientation.w = float(metres), 1.0
        path.poses.append(pose)
    return path


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "replay_in_browser", CockpitReplayTest)
