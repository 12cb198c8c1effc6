#!/usr/bin/env python3
"""Two runs of a service, one of which skips idle time: ground truth, battery and journal are the same."""

import multiprocessing
import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import rosgraph
import rospy
import rostest
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState
from waiting import wait_until

from planar.maps.places import load_places
from planar_ros.lockstep.client import OBSERVERS_PARAMETER
from planar_ros.messages.conversion import pose2_from_msg
from service.journal import Journal
from service.requests.admission import Admission
from service.requests.parser import Knowledge
from service.requests.repetitions import Repetitions
from service.task_book import TaskBook
from supervision.ros.graph import free_port

HERE = Path(__file__).parent
# As in idle_time.launch [Unix s].
ORIGIN = 1.9e9
REQUESTS = {150.0: "deliver cup from pickup to dropoff", 300.0: "go pickup"}
# When the runs end, with the robot in its dock again [simulated s], and wall-clock time for each.
END, PATIENCE = 460.0, 180.0
# Wall-clock time in which a graph ends [s].
END_SECONDS = 30.0
# The estimate is updated at rest, at other scans; so drives differ by the noise of the localization, which
# makes some tenths of a second and some millimetres.
MOST_SECONDS, MOST_METRES, MOST_CHARGE = 2.0, 0.02, 1e-3


class SameIdleTimeTest(unittest.TestCase):
    def test_a_run_that_skips_idle_time_has_the_same_states(self):
        skipping, stepping = (recorded_run(skips) for skips in (True, False))
        self.assertLess(len(skipping["poses"]), 0.5 * len(stepping["poses"]))
        self.check_journals(skipping["log"], stepping["log"])
        common = sorted(skipping["poses"].keys() & stepping["poses"].keys())
        started = next(stamp for stamp, kind, *_ in skipping["log"] if kind == "started")
        idle = [stamp for stamp in common if 0.0 < stamp < started]
        self.assertGreater(len(idle), 100)
        for stamp in idle:
            self.assertEqual(skipping["poses"][stamp], stepping["poses"][stamp])
        skipped_to, stepped_to = (run["poses"][common[-1]] for run in (skipping, stepping))
        self.assertLess(skipped_to.distance_to(stepped_to), MOST_METRES)
        self.check_charges(skipping["charges"], stepping["charges"], started)

    def check_journals(self, skipping, stepping):
        self.assertEqual([entry[1:] for entry in skipping], [entry[1:] for entry in stepping])
        self.assertEqual(skipping[-1][3], "is in the dock")
        for (skipped, *entry), (stepped, *_) in zip(skipping, stepping):
            self.assertAlmostEqual(skipped, stepped, delta=MOST_SECONDS, msg=str(entry))

    def check_charges(self, skipping, stepping, started):
        for stamp in skipping.keys() & stepping.keys():
            if stamp < started:
                self.assertEqual(skipping[stamp], stepping[stamp])
            self.assertAlmostEqual(skipping[stamp], stepping[stamp], delta=MOST_CHARGE)


def recorded_run(skips):
    """Return what a run came to; in another process, as rospy joins one graph in its life."""
    context = multiprocessing.get_context("spawn")
    queue = context.Queue()
    process = context.Process(target=record, args=(skips, queue))
    process.start()
    try:
        return queue.get(timeout=PATIENCE + END_SECONDS)
    finally:
        process.join(END_SECONDS)


def record(skips, queue):
    """Run a service until END; put poses and charges by stamp [s] and the entries of its log into a queue."""
    with tempfile.TemporaryDirectory() as name:
        folder, port = Path(name), free_port()
        request_in_advance(folder / "journal.db")
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
        arguments = [f"skip_idle:={str(skips).lower()}", f"state_folder:={folder}", "observer:=recorder"]
        command = ["roslaunch", "-p", str(port), str(HERE / "idle_time.launch"), *arguments]
        graph = subprocess.Popen([*command, "park_seconds:=30"])
        try:
            queue.put({**observed_until(END), "log": log_of(folder / "journal.db")})
        finally:
            graph.send_signal(signal.SIGINT)
            graph.wait(END_SECONDS)


def observed_until(end):
    """Return poses and charges by stamp."""
    poses, charges = {}, {}

    def on_truth(message):
        poses[message.header.stamp.to_sec()] = pose2_from_msg(message.pose.pose)

    def on_battery(message):
        charges[message.header.stamp.to_sec()] = message.percentage

    wait_until("the master", rosgraph.is_master_online, PATIENCE)
    wait_until("the parameters", lambda: rospy.has_param("/service/origin"), PATIENCE)
    rospy.init_node("recorder", argv=[], disable_signals=True)  # not with the name that rostest gives
    rospy.Subscriber("base_pose_ground_truth", Odometry, on_truth, tcp_nodelay=True)
    rospy.Subscriber("battery_state", BatteryState, on_battery)
    rospy.set_param(OBSERVERS_PARAMETER, [rospy.get_name()])
    wait_until("the end", lambda: rospy.get_time() >= end, PATIENCE, 0.02)
    return {
        "poses": {stamp: pose for stamp, pose in poses.copy().items() if stamp <= end},
        "charges": {stamp: charge for stamp, charge in charges.copy().items() if stamp <= end},
    }


def request_in_advance(path):
    """Make a journal with open requests."""
    journal, book, places = Journal(path), TaskBook(), load_places(HERE.parents[1] / "map" / "zones.yaml")
    known = Knowledge(tuple(places), True)
    admission = Admission(book, places, known, Repetitions(book, None), max_open=10)
    for start, text in REQUESTS.items():
        begin = {"unix_millis_earliest_start_time": round(1000.0 * (ORIGIN + start))}
        admission.submit({"text": text, **begin}, ORIGIN)
    journal.store(book.take_changes(), book.next_number)
    journal.close()


def log_of(path):
    """Return the entries of a journal's log until END: simulated time [s], kind, task, text."""
    journal = Journal(path, is_reader=True)
    found = [(each.stamp - ORIGIN, each.kind, each.task, each.text) for _, each in journal.log_after(0)]
    journal.close()
    return [entry for entry in found if entry[0] <= END]


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "same_idle_time", SameIdleTimeTest)
